#include "measure/smooth_outcome.hpp"

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "measure/surface_distance.hpp"
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"
#include "support/tissues.hpp"

namespace {

// Positions that no symmetry favours.
Vectors moved_at_random(const Tissue& tissue, unsigned seed) {
  Vectors positions = tissue.rest_positions;
  Random random(seed);
  for (Vec3& x : positions) x += random.vector(1);
  tissue.place_hanging_positions(positions);
  return positions;
}

TEST(SmoothOutcome, GradientsAgreeWithDifferences) {
  const std::string monitors = R"([monitor.area]
quantity = "area"
over = "sum"
face = "basal"
[monitor.ratio]
quantity = "area_ratio"
over = "rms"
region = "furrow"
[monitor.volume]
quantity = "volume"
over = "rms"
[monitor.moved]
quantity = "displacement"
[monitor.side]
quantity = "position"
axis = "y"
face = "apical"
over = "rms"
[monitor.low]
quantity = "position"
axis = "z"
over = "min"
[monitor.inward]
quantity = "inward_displacement"
region = "furrow"
over = "max"
[monitor.groove]
quantity = "depth"
region = "furrow"
[enclosed.yolk]
)";
  ScenarioSource source = find_scenario("drosophila");
  source.text += monitors;
  Simulation::Parts parts = parts_of(load_scenario(source, {"vitelline.gap_um=0.5"}));
  const TriangleSurface plane{{{-1000, 0, 120}, {1000, -900, 120}, {1000, 900, 140}}, {{0, 1, 2}}};
  Monitor& near = parts.measure_plan.monitors.emplace_back();
  near.name = "near";
  near.quantity = quantity_named("surface_distance");
  near.reference_surface = std::make_shared<const SurfaceDistance>(plane);
  const Tissue& tissue = parts.model->tissue;
  int cases = 0;
  for (const char* name :
       {"furrow_depth_um", "vml_apical_area_ratio", "enclosed_volume_ratio", "area.area_um2", "ratio.area_ratio",
        "volume.volume_um3", "moved.displacement_um", "side.position_um", "low.position_um",
        "inward.inward_displacement_um", "groove.depth_um", "vce_apical_area_ratio", "vml_height_um", "mean_height_um",
        "lip_distance_um", "lumen_volume_ratio", "near.surface_distance_um"}) {
    const Vectors positions = moved_at_random(tissue, 3);
    const SmoothOutcome outcome = smooth_outcome(name, *parts.model, parts.measure_plan, positions);
    const Vectors direction = Random(4).vectors(tissue.node_count());
    const auto value_at = [&](double way) {
      Vectors there = positions;
      for (std::size_t n = 0; n < there.size(); ++n) there[n] += way * direction[n];
      return smooth_outcome(name, *parts.model, parts.measure_plan, there).value;
    };
    const double d = 1e-5, difference = (value_at(d) - value_at(-d)) / (2 * d);
    EXPECT_NEAR(parallel_dot(outcome.gradient, direction), difference, 1e-6 * std::abs(difference)) << name;
    ++cases;
  }
  EXPECT_EQ(cases, 17);
  // Values are those of series.csv.
  State state = rest_state(*parts.model);
  state.positions = moved_at_random(tissue, 5);
  const Observation row = Observer(*parts.model, parts.measure_plan).observe({*parts.model, state}, nullptr);
  for (const char* name : {"furrow_depth_um", "vml_apical_area_ratio", "enclosed_volume_ratio", "vce_apical_area_ratio",
                           "vml_height_um", "mean_height_um", "lip_distance_um", "lumen_volume_ratio"})
    EXPECT_DOUBLE_EQ(smooth_outcome(name, *parts.model, parts.measure_plan, state.positions).value, row[name].value())
        << name;
}

TEST(SmoothOutcome, OthersAreNamed) {
  const Simulation::Parts parts = parts_of(load_scenario(pulled_block()));
  for (const auto& [name, why] :
       {std::pair{"max_node_speed_um_per_s", "has no gradient"}, std::pair{"furrow_dept_um", "is no output variable"}})
    try {
      (void)smooth_outcome(name, *parts.model, parts.measure_plan, parts.model->tissue.rest_positions);
      FAIL();
    } catch (const UsageError& error) {
      EXPECT_EQ(error.what(), fmt::format("outcome \"{}\": {}; those with a gradient: mean_height_um, all.volume_um3, "
                                          "end.position_um, side.position_um; add a monitor of area, area_ratio, "
                                          "volume, position, displacement, inward_displacement, depth or "
                                          "surface_distance",
                                          name, why));
    }
}

}  // namespace
