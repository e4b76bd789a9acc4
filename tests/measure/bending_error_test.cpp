#include "measure/bending_error.hpp"

#include <gtest/gtest.h>

#include "mechanics/elasticity/corotational.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

// A row of two cells whose top faces shrink and whose bottom faces widen by as much.
TEST(BendingError, GrowsWithTheDifferenceOfAreasAndFallsWithLayers) {
  int cases = 0;
  for (const int layers : {1, 2, 4}) {
    Model model(build_block({.length_um = 20,
                             .width_um = 10,
                             .cell_height_um = 10,
                             .cells = {2, 1, 1},
                             .elements_per_cell = {1, 1, layers}}));
    EXPECT_FALSE(bending_error(model, model.tissue.rest_positions));  // no law
    model.laws.push_back(std::make_unique<Corotational>(model.tissue, ElasticModuli::from_young(1, 0.45), 0));
    EXPECT_FALSE(bending_error(model, model.tissue.rest_positions));
    Vectors x = model.tissue.rest_positions;
    for (Vec3& one : x) one.x() *= 1 - 0.02 * one.z();
    EXPECT_NEAR(bending_error(model, x).value(), 0.14 * 0.2 / layers, 1e-12);
    EXPECT_EQ(elements_through_height(model.tissue), layers);
    for (Vec3& one : x) one = 0.7 * one;  // all alike: no more bending than that of the areas
    EXPECT_NEAR(bending_error(model, x).value(), 0.14 * 0.2 * 0.49 / layers, 1e-12);
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

}  // namespace
}  // namespace plica
