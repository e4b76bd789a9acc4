#include "measure/columns.hpp"
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"

namespace {

std::pair<double, double> shape_index_of(const std::string& embryo) {
  const Simulation simulation(scenario_of("[embryo]\n" + embryo + "[measure]\nsets = [\"shape\"]\n"));
  const Observation& row = simulation.measures();
  return {*row["apical_shape_index"], *row["apical_shape_index_deviation"]};
}

// A square of side a: 4 a / a. A rectangle of sides 1 and 2: 6 / sqrt(2).
TEST(ShapeIndex, OfSquaresAndRectangles) {
  const std::string block = "shape = \"block\"\ncell_height_um = 10\ncells = [3, 1, 1]\nwidth_um = 10\n";
  const auto [square, none] = shape_index_of(block + "length_um = 30\n");
  EXPECT_NEAR(square, 4, 1e-12);
  EXPECT_NEAR(none, 0, 1e-7);
  EXPECT_NEAR(shape_index_of(block + "length_um = 60\n").first, 6 / std::sqrt(2.0), 1e-12);
}

// Irregular polygons are longer around than regular hexagons: 2 sqrt(2 sqrt(3)) = 3.722.
TEST(ShapeIndex, OfIrregularPolygonsIsAboveThatOfHexagons) {
  const auto [mean, deviation] =
      shape_index_of("shape = \"sheet\"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = 10\n");
  EXPECT_GT(mean, 2 * std::sqrt(2 * std::sqrt(3.0)));
  EXPECT_LT(mean, 4.2);
  EXPECT_GT(deviation, 0.01);
}

}  // namespace
