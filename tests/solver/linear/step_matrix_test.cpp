#include "solver/linear/step_matrix.hpp"

#include <gtest/gtest.h>

#include <set>

#include "support/law_checks.hpp"
#include "support/models.hpp"
#include "support/threads.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using namespace support;

std::vector<double> volume_rates(const StepMatrix& matrix, const Vectors& direction) {
  std::vector<double> rates(matrix.jacobian().cells());
  matrix.jacobian().rates(direction, rates);
  return rates;
}

TEST(StepMatrix, ProductIsTheSumOfTheLawsMatrixFreeProducts) {
  int cases = 0;
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 2, 1}, {1, 2, 2}}) {
    const Model model = dimpling_sheet(elements);
    const Motion motion = random_motion(model.tissue, 2, 1);
    Random random(2);
    std::vector<double> pressures;
    for (std::size_t c = 0; c < model.volumes.count(); ++c) pressures.push_back(random.number());

    StepMatrix matrix(model);
    matrix.set_zero();
    for (const auto& law : model.laws) law->add_tangent(motion.step(), matrix);
    model.volumes.add_tangent(motion.positions, pressures, matrix);

    const Vectors direction = random.vectors(model.tissue.node_count());
    Vectors expected(direction.size(), Vec3::Zero());
    for (const auto& law : model.laws) law->add_tangent_product(motion.step(), direction, expected);
    model.volumes.add_tangent_product(motion.positions, pressures, direction, expected);
    const Vectors assembled = product_of(matrix, direction);
    for (std::size_t n = 0; n < expected.size(); ++n)
      EXPECT_LE((assembled[n] - expected[n]).norm(), 1e-12 * largest(expected));
    ++cases;
  }
  RecordProperty("cases", cases);
}

TEST(StepMatrix, VolumeRatesAreTheDerivativesOfTheVolumes) {
  const Model model = dimpling_sheet({2, 2, 1});
  Motion motion = random_motion(model.tissue, 2, 4);
  StepMatrix matrix(model);
  matrix.set_volume_gradients(model.volumes, motion.positions);
  const Vectors direction = Random(4).vectors(model.tissue.node_count());
  const std::vector<double> rates = volume_rates(matrix, direction);
  const double d = 1e-4;
  Vectors above = motion.positions, below = motion.positions;
  for (std::size_t n = 0; n < direction.size(); ++n) {
    above[n] += d * direction[n];
    below[n] -= d * direction[n];
  }
  const auto v_above = model.volumes.volumes(above), v_below = model.volumes.volumes(below);
  ASSERT_EQ(rates.size(), 9u);
  for (std::size_t c = 0; c < rates.size(); ++c) EXPECT_NEAR(rates[c], (v_above[c] - v_below[c]) / (2 * d), 1e-5);
}

TEST(StepMatrix, PressureForcesAreThoseOfTheVolumes) {
  const Model model = dimpling_sheet({1, 1, 2});
  const Motion motion = random_motion(model.tissue, 2, 5);
  StepMatrix matrix(model);
  matrix.set_volume_gradients(model.volumes, motion.positions);
  Random random(6);
  std::vector<double> pressures;
  for (std::size_t c = 0; c < model.volumes.count(); ++c) pressures.push_back(random.number());
  Vectors through_matrix(model.tissue.node_count(), Vec3::Zero()), direct = through_matrix;
  matrix.jacobian().add_forces(pressures, 1, through_matrix);
  model.volumes.add_forces(motion.positions, pressures, direct);
  for (std::size_t n = 0; n < direct.size(); ++n)
    EXPECT_LE((through_matrix[n] - direct[n]).norm(), 1e-13 * largest(direct));
}

// On one thread cells scatter them, on two nodes gather them.
TEST(StepMatrix, PressureForcesAreTheSameBitsOnOneAndTwoThreads) {
  const Model model(build_shell({.elements_per_cell = {3, 3, 2}}));
  ASSERT_GT(model.tissue.node_count(), 10'000u);  // worth sharing
  VolumeJacobian jacobian(model);
  jacobian.update(model.volumes, model.tissue.rest_positions);
  Random random(8);
  std::vector<double> pressures(jacobian.cells());
  for (double& pressure : pressures) pressure = random.number();
  const auto forces_on = [&](int count) {
    const support::Threads scope(count);
    Vectors forces(model.tissue.node_count(), Vec3::Ones());
    jacobian.add_forces(pressures, 0.3, forces);
    return forces;
  };
  const Vectors on_one = forces_on(1), on_two = forces_on(2);
  EXPECT_EQ(on_one, on_two);
}

// The written values are Q^T [A -J^T; -J 0] Q with Q the frames, rows and columns of fixed unknowns emptied.
TEST(StepMatrix, WrittenValuesAreTheFramedSystem) {
  const Model model = dimpling_sheet();
  const Motion motion = random_motion(model.tissue, 2, 8);
  StepMatrix matrix(model);
  matrix.set_zero();
  for (const auto& law : model.laws) law->add_tangent(motion.step(), matrix);
  matrix.set_volume_gradients(model.volumes, motion.positions);

  const int nodes = static_cast<int>(model.tissue.node_count()), cells = 9, size = 3 * nodes + cells;
  Random random(8);
  std::vector<NodeFrame> frames(nodes);
  Eigen::MatrixXd Q = Eigen::MatrixXd::Identity(size, size);
  std::vector<bool> fixed(size, false);
  for (int n = 0; n < nodes; ++n) {
    frames[n].fixed = n % 4;
    if (frames[n].fixed > 0) frames[n].axes = random.rotation();
    Q.block<3, 3>(3 * n, 3 * n) = frames[n].axes;
    for (int i = 0; i < frames[n].fixed; ++i) fixed[3 * n + i] = true;
  }
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(size, size);
  Vectors unit(nodes, Vec3::Zero());
  for (int i = 0; i < 3 * nodes; ++i) {
    unit[i / 3][i % 3] = 1;
    system.col(i).head(3 * nodes) = flat(product_of(matrix, unit));
    const std::vector<double> rates = volume_rates(matrix, unit);
    for (int c = 0; c < cells; ++c) system(3 * nodes + c, i) = system(i, 3 * nodes + c) = -rates[c];
    unit[i / 3][i % 3] = 0;
  }
  const Eigen::MatrixXd expected = Q.transpose() * system * Q;

  std::vector<double> values;
  matrix.write_values(frames, values);
  const SymmetricPattern pattern = matrix.pattern();
  ASSERT_EQ(pattern.size, size);
  ASSERT_EQ(values.size(), pattern.rows.size());
  Eigen::MatrixXd written = Eigen::MatrixXd::Zero(size, size);
  std::set<std::pair<int, int>> places;
  for (std::size_t k = 0; k < values.size(); ++k) {
    EXPECT_GE(pattern.rows[k], pattern.columns[k]) << "lower triangle";
    EXPECT_TRUE(places.emplace(pattern.rows[k], pattern.columns[k]).second) << "each place once";
    written(pattern.rows[k], pattern.columns[k]) = written(pattern.columns[k], pattern.rows[k]) = values[k];
  }
  const double scale = expected.cwiseAbs().maxCoeff();
  for (int i = 0; i < size; ++i)
    for (int j = 0; j < size; ++j) {
      if (i == j && fixed[i]) {
        EXPECT_GT(written(i, i), 0) << "a fixed unknown needs a pivot";
      } else {
        EXPECT_NEAR(written(i, j), fixed[i] || fixed[j] ? 0 : expected(i, j), 1e-12 * scale);
      }
    }
}

// A node that is held needs no stiffness for that: nothing pulls at these, and the system is still not singular.
TEST(StepMatrix, AFixedUnknownWithoutStiffnessHasAPivot) {
  Model model(build_block({.cells = {1, 1, 1}}));
  model.volumes_are_held = false;
  StepMatrix matrix(model);
  matrix.set_zero();
  std::vector<NodeFrame> frames(model.tissue.node_count());
  for (NodeFrame& frame : frames) frame.fixed = 3;
  std::vector<double> values;
  matrix.write_values(frames, values);
  const SymmetricPattern pattern = matrix.pattern();
  for (std::size_t k = 0; k < values.size(); ++k)
    if (pattern.rows[k] == pattern.columns[k]) {
      EXPECT_GT(values[k], 0) << "row " << pattern.rows[k];
    }
}

}  // namespace
}  // namespace plica
