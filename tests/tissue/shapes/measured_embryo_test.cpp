// The average fly embryo of the Berkeley Drosophila Transcription Network Project (Fowlkes et al. 2008, Cell 133:364):
// cells about its 6078 nuclei.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numeric>

#include "tissue/files/points_file.hpp"
#include "tissue/shapes/extrusion.hpp"
#include "tissue/shapes/surface_polygons.hpp"

namespace plica {
namespace {

// Nuclei lie 8 um below the surface of the fixed embryo, so they are moved out first and the embryo, surface and all,
// is then scaled to the living one.
Vectors living(const Vectors& nuclei, const StarSurface& fixed) {
  Vectors points;
  for (const Vec3& nucleus : nuclei)
    points.push_back((nucleus + 8 * fixed.closest(nucleus).normal).cwiseProduct(Vec3(1.22, 1.12, 1.12)));
  return points;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double percent(const std::vector<std::size_t>& counts, std::size_t corners, std::size_t all) {
  return corners < counts.size() ? 100.0 * static_cast<double>(counts[corners]) / static_cast<double>(all) : 0;
}

class MeasuredEmbryo : public testing::Test {
 protected:
  const Vectors nuclei = read_points_file(PLICA_SOURCE_DIR "/scenarios/data/drosophila_atlas.csv").points;
};

TEST_F(MeasuredEmbryo, HasCellsOfAnEpithelium) {
  ASSERT_EQ(nuclei.size(), 6078U);
  const StarFit fit = fit_star_surface(nuclei);
  EXPECT_LT(fit.rms_um, 0.4);
  const CellPolygons cells = polygons_of_points(nuclei, fit.surface);
  EXPECT_NEAR(static_cast<double>(cells.flipped_edges), 5000, 500);
  const auto counts = corner_counts(cells.surface);
  EXPECT_NEAR(percent(counts, 4, 6078), 0.3, 0.1);
  EXPECT_NEAR(percent(counts, 5, 6078), 15, 1);
  EXPECT_NEAR(percent(counts, 6, 6078), 69, 1);
  EXPECT_NEAR(percent(counts, 7, 6078), 14, 1);
  EXPECT_NEAR(percent(counts, 8, 6078), 0.6, 0.2);
}

TEST_F(MeasuredEmbryo, LivesAsAnEggOfTheKnownSize) {
  double begin = seconds_now();
  const auto stage = [&](const char* name) {
    fmt::print("{}: {:.3f} s\n", name, seconds_now() - begin);
    begin = seconds_now();
  };
  const Vectors points = living(nuclei, fit_star_surface(nuclei).surface);
  stage("fixed surface");
  const StarFit fit = fit_star_surface(points);
  stage("living surface");
  const CellPolygons cells = polygons_of_points(points, fit.surface);
  stage("polygons");
  const ExtrudedSheet sheet = extrude(cells.surface, vertex_bends(cells.surface, fit.surface), std::array{35.0});
  stage("prisms");

  Vec3 low = Vec3::Zero(), high = Vec3::Zero();
  for (const Vec3& vertex : sheet.apical) {
    low = low.cwiseMin(vertex);
    high = high.cwiseMax(vertex);
  }
  const Vec3 size = high - low;
  EXPECT_NEAR(size.x(), 500, 5);
  EXPECT_NEAR(size.y(), 180, 3);
  EXPECT_NEAR(size.z(), 180, 3);

  const std::vector<double> areas = polygon_areas({sheet.apical, sheet.cells}),
                            basal = polygon_areas({sheet.basal, sheet.cells}), volumes = prism_volumes(sheet);
  std::vector<double> ventral_tapers, ventral_areas;
  for (std::size_t i = 0; i < areas.size(); ++i) {
    // 42 degrees to either side of the belly, over the middle three fifths of the length.
    const bool ventral = std::abs(points[i].y()) < 0.9 * -points[i].z() && std::abs(points[i].x()) < 150;
    if (!ventral) continue;
    ventral_tapers.push_back(basal[i] / areas[i]);
    ventral_areas.push_back(areas[i]);
  }
  const auto counts = corner_counts(cells.surface);
  fmt::print("size {:.1f} x {:.1f} x {:.1f} um; fit rms {:.2f} um, largest {:.2f} um\n", size.x(), size.y(), size.z(),
             fit.rms_um, fit.largest_um);
  fmt::print("corners 4 to 8: {:.1f} {:.1f} {:.1f} {:.1f} {:.1f} %; {} edges lengthened, {} corners sharpened\n",
             percent(counts, 4, 6078), percent(counts, 5, 6078), percent(counts, 6, 6078), percent(counts, 7, 6078),
             percent(counts, 8, 6078), cells.lengthened_edges, cells.sharpened_corners);
  fmt::print("apical area {:.1f} um^2, ventral {:.1f}; volume {:.0f} um^3; ventral taper {:.3f}\n", mean(areas),
             mean(ventral_areas), mean(volumes), mean(ventral_tapers));
  fmt::print("lower than asked for: {} cells, least {:.1f} um\n", sheet.lower_cells, sheet.lowest_um);
  EXPECT_NEAR(mean(areas), 39, 2);
  EXPECT_NEAR(mean(volumes), 1000, 50);
  EXPECT_GT(mean(ventral_tapers), 0.52);
  EXPECT_LT(mean(ventral_tapers), 0.61);
  EXPECT_GT(*std::ranges::min_element(volumes), 400);
  const double yolk = 1 - mean(volumes) * static_cast<double>(volumes.size()) / fit.surface.volume();
  EXPECT_GT(yolk, 0.26);
  EXPECT_LT(yolk, 0.36);
  EXPECT_LT(sheet.lower_cells, 1000);
}

}  // namespace
}  // namespace plica
