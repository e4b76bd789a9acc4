#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/errors.hpp"
#include "measure/energy_norm.hpp"
#include "record/mesh_writer.hpp"
#include "study/compare.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;
using namespace support;

class CompareTest : public testing::Test {
 protected:
  CompareTest() : folder(fs::path(testing::TempDir()) / ("plica_compare_" + std::to_string(::getpid()))) {}
  ~CompareTest() override { fs::remove_all(folder); }

  /// A run with one frame: the block displaced by `displacements` from rest.
  [[nodiscard]] ReferenceRun run_with(const std::string& name, const Vectors& displacements,
                                      const std::string& scenario) const {
    fs::create_directories(folder / name / "frames");
    Vectors positions = block.rest_positions;
    for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += displacements[n];
    MeshArrays arrays;
    arrays.node_vectors = {{"displacement_um", displacements}};
    write_mesh(folder / name / "frames/frame_00000.vtu", block, positions, arrays, 7);
    write_collection(folder / name / "frames.pvd", {{7, "frames/frame_00000.vtu"}});
    std::ofstream(folder / name / "scenario.toml") << scenario;
    return ReferenceRun(folder / name);
  }

  fs::path folder;
  const Tissue block = distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 2, 9);
};

// Displacements as large as cells, so that shapes at rest and shapes now have different stiffness.
TEST_F(CompareTest, EnergyNormIsThatOfTheMeshAtRestAndOfTheScenariosPoissonRatio) {
  Random random(3);
  const Vectors u_a = random.vectors(block.node_count(), 6), u_b = random.vectors(block.node_count(), 6);
  const ReferenceRun a = run_with("a", u_a, ""), b = run_with("b", u_b, "[elasticity]\npoisson_ratio = 0.2\n");
  const Comparison found = compare_runs(a, a.last_frame(), b, b.last_frame());
  const RestMesh rest{block.elements, block.element_rest_shape, {}};
  const double expected = relative_energy_norm(rest, 0.2, u_a, u_b).value();
  EXPECT_NEAR(found.nodes.value().relative_energy_norm.value(), expected, 1e-9 * expected);
  EXPECT_GT(std::abs(relative_energy_norm(rest, 0.45, u_a, u_b).value() / expected - 1), 1e-3);

  double sum = 0, largest = 0;
  for (std::size_t n = 0; n < u_a.size(); ++n) {
    sum += (u_a[n] - u_b[n]).norm();
    largest = std::max(largest, (u_a[n] - u_b[n]).norm());
  }
  EXPECT_NEAR(found.nodes->distances.mean, sum / static_cast<double>(u_a.size()), 1e-9);
  EXPECT_NEAR(found.nodes->distances.max, largest, 1e-9);
  const std::size_t farthest = found.nodes->farthest.index();
  EXPECT_NEAR((u_a[farthest] - u_b[farthest]).norm(), largest, 1e-9);
}

TEST_F(CompareTest, AScenarioThatIsNotUnderstoodLeavesTheEnergyNormOut) {
  const Vectors u(block.node_count(), Vec3(1, 0, 0));
  const ReferenceRun run = run_with("a", u, "[elasticity]\npoisson = 0.2\n");
  const Comparison found = compare_runs(run, run.last_frame(), run, run.last_frame());
  EXPECT_FALSE(found.nodes.value().relative_energy_norm);
  EXPECT_EQ(found.nodes->distances.max, 0);
}

TEST_F(CompareTest, VolumesOfInvertedElementsAreNegative) {
  Vectors mirrored = block.rest_positions;
  for (Vec3& x : mirrored) x = Vec3(0, 0, -2 * x.z());  // z to -z
  const ReferenceRun a = run_with("a", mirrored, ""), b = run_with("b", Vectors(block.node_count(), Vec3::Zero()), "");
  const Comparison found = compare_runs(a, a.last_frame(), b, b.last_frame());
  ASSERT_EQ(found.geometry.at(0).name, "volume_um3");
  EXPECT_GT(*found.geometry[0].b, 0);
  EXPECT_NEAR(*found.geometry[0].a, -*found.geometry[0].b, 1e-6);
}

TEST_F(CompareTest, FramesByTime) {
  const ReferenceRun run = run_with("a", Vectors(block.node_count(), Vec3::Zero()), "");
  EXPECT_EQ(frame_to_compare(run, {}).time_s, 7);
  EXPECT_EQ(frame_to_compare(run, 7 + 1e-9).time_s, 7);
  EXPECT_THROW((void)frame_to_compare(run, 6.9), UsageError);
}

}  // namespace
}  // namespace plica
