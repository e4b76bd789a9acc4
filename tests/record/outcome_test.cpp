// The line that describes what a tissue did, in words that fit it, and the one about self-intersections.
#include "record/outcome.hpp"

#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "simulation/run_warnings.hpp"
#include "support/tissues.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

Scenario scenario_of(const std::string& keys) { return load_scenario({"test", "test.toml", keys}); }

const Tissue& sheet() {
  static const Tissue tissue = support::distorted_block({60, 40, 10, {6, 4, 1}, {1, 1, 1}}, 1, 3);
  return tissue;
}

const Tissue& closed() {
  static const Tissue tissue = build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}});
  return tissue;
}

const Json contracted = {{"furrow_depth_um", 28.9},
                         {"vml_apical_area_ratio", 0.68},
                         {"peak_speed_ratio", nullptr},
                         {"lips_closed", nullptr},
                         {"divisions", 0},
                         {"max_displacement_um", 32.5},
                         {"min_apical_area_ratio", 0.52},
                         {"lumen_volume_ratio", nullptr},
                         {"tissue_volume_ratio", 1}};

Json with(const Json& changes) {
  Json summary = contracted;
  summary.update(changes);
  return summary;
}

TEST(Outcome, OfAnEmbryoIsItsFurrow) {
  const Scenario pill = scenario_of("[embryo]\nshape = \"pill\"\n");
  EXPECT_EQ(outcome_text(pill, closed(), contracted), "furrow depth 28.90 um, apical area ratio 0.68 (midline centre)");
  EXPECT_EQ(outcome_text(pill, closed(), with({{"lips_closed", 1}, {"lips_closed_time_s", 900}})),
            "furrow depth 28.90 um, apical area ratio 0.68 (midline centre), lips closed at 15.00 min");
  EXPECT_EQ(outcome_text(pill, closed(), with({{"lips_closed", 0}, {"lips_closed_time_s", 900}, {"divisions", 2}})),
            "furrow depth 28.90 um, apical area ratio 0.68 (midline centre), lips open again, closed at 15.00 min, " +
                std::to_string(closed().cells.size()) + " cells after 2 divisions");
  EXPECT_EQ(outcome_text(pill, closed(), with({{"furrow_depth_um", nullptr}, {"lumen_volume_ratio", 1.2}})),
            "largest displacement 32.50 um, smallest apical area ratio 0.52, lumen volume ratio 1.20");
}

TEST(Outcome, OfOtherTissuesHasNoFurrow) {
  const Scenario flat = scenario_of("[embryo]\nshape = \"sheet\"\n");
  const std::string rest = "largest displacement 32.50 um, smallest apical area ratio 0.52";
  EXPECT_EQ(outcome_text(flat, sheet(), contracted), "fold depth 28.90 um, " + rest);
  EXPECT_EQ(outcome_text(flat, sheet(), with({{"furrow_depth_um", nullptr}, {"lumen_volume_ratio", 1}})), rest);
  EXPECT_EQ(outcome_text(flat, closed(),
                         with({{"furrow_depth_um", nullptr}, {"tissue_volume_ratio", 1.98}, {"divisions", 1}})),
            rest + ", " + std::to_string(closed().cells.size()) + " cells after 1 division, tissue volume ratio 1.98");
  const Scenario named = scenario_of("[embryo]\nshape = \"sheet\"\naxes = [\"x\", \"y\", \"ventral-dorsal\"]\n");
  EXPECT_TRUE(outcome_text(named, sheet(), contracted).starts_with("furrow depth 28.90 um"));
}

TEST(Outcome, TellsOfSelfIntersectionsWithTheirRemedy) {
  const Scenario none = scenario_of(""), both = scenario_of("[self_contact]\nsurface = \"both\"\n");
  const Json crossed = {{"self_intersections", 38}, {"self_intersections_time_s", 225}, {"lumen_volume_ratio", 0.9}};
  const std::string told = "self-intersects since 3.75 min (38 pairs of faces at most); later results are unphysical";
  EXPECT_EQ(crossing_text(none, crossed), told + crossing_remedy(none));
  EXPECT_EQ(crossing_text(both, crossed), told);
  EXPECT_EQ(crossing_text(none, {{"self_intersections", 0}, {"self_intersections_time_s", nullptr}}), "");
}

}  // namespace
}  // namespace plica
