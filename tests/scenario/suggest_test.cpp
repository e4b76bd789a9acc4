#include "scenario/suggest.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

// The order of two near names does not matter.
TEST(Suggest, TheNearestOfSeveralThatAreNear) {
  EXPECT_EQ(nearest_name("stifness", {"stiffness", "stillness"}), "stiffness");
  EXPECT_EQ(nearest_name("stifness", {"stillness", "stiffness"}), "stiffness");
  // A swap of two letters is one edit; a deletion and an insertion are two.
  EXPECT_EQ(nearest_name("gpa", {"gab", "gap"}), "gap");
  EXPECT_EQ(nearest_name("yolk_gpa", {"yolk_gal", "yolk_gap"}), "yolk_gap");
  EXPECT_EQ(nearest_name("lengt_um", {"length_um", "height_um"}), "length_um");
  EXPECT_EQ(nearest_name("lengt_um", {"height_um", "length_um"}), "length_um");
}

TEST(Suggest, CaseDoesNotCount) {
  EXPECT_EQ(nearest_name("YOUNG_MODULUS_PA", {"poisson_ratio", "young_modulus_Pa"}), "young_modulus_Pa");
  EXPECT_EQ(nearest_name("Xenopus", {"drosophila", "xenopus"}), "xenopus");
}

TEST(Suggest, WhatIsFarFromAllIsNone) {
  EXPECT_FALSE(nearest_name("colour", {"length_um", "cells"}));
  EXPECT_FALSE(nearest_name("at", {"x", "is"})) << "no letter is the same";
  EXPECT_FALSE(nearest_name("cells", {}));
}

TEST(Suggest, TheBeginningOfANameIsEnough) {
  EXPECT_EQ(nearest_name("young", {"poisson_ratio", "young_modulus_Pa"}), "young_modulus_Pa");
  EXPECT_FALSE(nearest_name("you", {"poisson_ratio", "young_modulus_Pa"})) << "too short to say anything";
}

TEST(Suggest, AUnitIsWhatFollowsAName) {
  for (const char* name : {"young_modulus_Pa", "young_modulus_kPa", "young_modulus", "Young_Modulus_nN_per_um2"})
    EXPECT_EQ(without_unit(name), "young_modulus") << name;
  EXPECT_EQ(without_unit("um"), "um");
}

TEST(Suggest, WhereNothingIsNearAllThatIsKnownIsNamed) {
  EXPECT_EQ(did_you_mean("drosofila", {"xenopus", "drosophila"}), "use \"drosophila\" (nearest match)");
  EXPECT_EQ(did_you_mean("mouse", {"xenopus", "drosophila"}), "use one of: xenopus, drosophila");
  EXPECT_EQ(did_you_mean("mouse", {}), "none is defined");
}

}  // namespace
}  // namespace plica
