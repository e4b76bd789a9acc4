// Measures of the whole tissue: largest displacement, mean height, volume.
#include "measure/cells.hpp"

#include <gtest/gtest.h>

#include "support/models.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

TEST(WholeTissue, IsMeasuredByDisplacementHeightAndVolume) {
  const Model model(support::distorted_block({60, 40, 12, {3, 2, 1}, {1, 1, 2}}, 0, 1));
  Vectors positions = model.tissue.rest_positions;
  EXPECT_EQ(max_displacement(model.tissue, positions), 0);
  EXPECT_NEAR(mean_height(model.tissue, positions), 12, 1e-9);
  EXPECT_NEAR(tissue_volume(model, positions), 60 * 40 * 12, 1e-6);
  for (Vec3& position : positions) position = Vec3(position.x(), position.y(), 1.5 * position.z());
  positions[0] += Vec3(3, 4, 0);
  EXPECT_NEAR(tissue_volume(model, positions) / (60 * 40 * 12), 1.5, 0.2);
  double farthest = 0;
  for (std::size_t n = 0; n < positions.size(); ++n)
    farthest = std::max(farthest, (positions[n] - model.tissue.rest_positions[n]).norm());
  EXPECT_NEAR(max_displacement(model.tissue, positions), farthest, 1e-12);
}

}  // namespace
}  // namespace plica
