// Matrix of a step, and the factor of its chequerboard forces.
#include "solver/linear/step_matrix.hpp"

#include "core/threads.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "solver/linear/chequerboard_factor.hpp"
#include "solver/linear/directions.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

std::vector<double> volume_rates(const StepMatrix& matrix, const Vectors& direction) {
  std::vector<double> rates(matrix.jacobian().sparse_rows());
  matrix.jacobian().rates(direction, rates);
  return rates;
}

TEST(StepMatrix, ProductIsTheSumOfTheLawsMatrixFreeProducts) {
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
  }
}

TEST(StepMatrix, VolumeRatesAreTheDerivativesOfTheVolumes) {
  const Model model = dimpling_sheet({2, 2, 1});
  Motion motion = random_motion(model.tissue, 2, 4);
  StepMatrix matrix(model);
  matrix.take_gradients(model, motion.positions);
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
  matrix.take_gradients(model, motion.positions);
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
  ConstraintJacobian jacobian(model);
  jacobian.update(model, model.tissue.rest_positions);
  Random random(8);
  std::vector<double> pressures(jacobian.sparse_rows());
  for (double& pressure : pressures) pressure = random.number();
  const auto forces_on = [&](int count) {
    const ThreadCount scope(count);
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
  matrix.take_gradients(model, motion.positions);

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
  const Rows pattern = matrix.pattern();
  ASSERT_EQ(pattern.count(), size);
  ASSERT_EQ(values.size(), pattern.columns.size());
  Eigen::MatrixXd written = Eigen::MatrixXd::Zero(size, size);
  std::set<std::pair<int, int>> places;
  for (int row = 0; row < size; ++row)
    for (int k = pattern.starts[row]; k < pattern.starts[row + 1]; ++k) {
      const int column = pattern.columns[k];
      EXPECT_GE(row, column) << "lower triangle";
      EXPECT_TRUE(places.emplace(row, column).second) << "each place once";
      written(row, column) = written(column, row) = values[k];
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
  model.volumes.hold(false);
  StepMatrix matrix(model);
  matrix.set_zero();
  std::vector<NodeFrame> frames(model.tissue.node_count());
  for (NodeFrame& frame : frames) frame.fixed = 3;
  std::vector<double> values;
  matrix.write_values(frames, values);
  const Rows pattern = matrix.pattern();
  for (int row = 0; row < pattern.count(); ++row) {
    ASSERT_GE(pattern.place(row, row), 0);
    EXPECT_GT(values[pattern.place(row, row)], 0) << "row " << row;
  }
}

// Joins two nodes of opposite ends of the sheet, of which it says nothing.
class Liar final : public Law {
 public:
  [[nodiscard]] std::string_view name() const override { return "liar"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Liar>(*this); }
  [[nodiscard]] double energy(const Step&) const override { return 0; }
  void add_forces(const Step&, std::span<Vec3>) const override {}
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}
  void add_tangent(const Step& step, TangentSink& tangent) const override {
    tangent.add_block(NodeId(step.positions.size() - 1), NodeId(std::size_t{0}), Mat3::Identity());
  }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue&, const Division&,
                                                    std::span<const Vec3>) const override {
    return clone();
  }
};

TEST(StepMatrix, ABlockOutsideThePatternIsAnErrorThatNamesTheLaw) {
  Model model = dimpling_sheet();
  model.laws.push_back(std::make_unique<Liar>());
  StepMatrix matrix(model);
  const State rest = rest_state(model);
  const Iterate at{rest.positions, rest.multipliers, rest.contact_forces, rest.in_contact};
  const Step step{rest.positions, rest.positions, rest.velocities, 1, 1};
  EXPECT_SAYS(error_of<std::logic_error>([&] { matrix.assemble(model, Contacts(model), step, at); }), "liar");
}

/// A ball of n x n squares a face, all cells of the same size, at rest, every third apical node free of the shell.
struct Ball {
  explicit Ball(int n) : model(build_shell({.length_um = 35.0 * n, .diameter_um = 35.0 * n, .cells = {n, n, n}})) {
    add_elasticity(model);
    add_drag(model, 0.1);
    model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
    const State rest = rest_state(model);
    at = {rest.positions, rest.multipliers, rest.contact_forces, rest.in_contact};
    for (std::size_t k = 0; k < at.in_contact.size(); ++k) at.in_contact[k] = k % 3 != 0;
    frames = node_frames(model, Contacts(model), at);
  }
  [[nodiscard]] Step step() const { return {at.positions, at.positions, velocities, 5, 5}; }

  Model model;
  Iterate at;
  std::vector<NodeFrame> frames;
  Vectors velocities = Vectors(model.tissue.node_count(), Vec3::Zero());
};

// L as it is defined, from products with J and its transpose.
TEST(ChequerboardFactor, IsTheInverseOfWhatForcesOnSingleNodesDo) {
  const Ball ball(8);
  StepMatrix matrix(ball.model);
  matrix.assemble(ball.model, Contacts(ball.model), ball.step(), ball.at);
  const ConstraintJacobian& jacobian = matrix.jacobian();
  ChequerboardFactor factor(jacobian, ball.frames.size());
  ASSERT_TRUE(factor.factorise(jacobian, matrix, ball.frames));
  Random random(1);
  std::vector<double> pressures(jacobian.sparse_rows());
  for (double& pressure : pressures) pressure = random.number();
  Vectors moves(ball.frames.size(), Vec3::Zero());
  jacobian.add_forces(pressures, 1, moves);
  factor.displace(moves);
  for (std::size_t n = 0; n < moves.size(); ++n) moves[n] = ball.frames[n].free_part(moves[n]);
  std::vector<double> found(pressures.size());
  jacobian.rates(moves, found);
  factor.solve(found);
  for (std::size_t c = 0; c < found.size(); ++c) EXPECT_NEAR(found[c], pressures[c], 1e-2);
}

// Neighbours with opposite pressures, all over the ball: the more cells, the less they move, and the more iterations
// it took before.
TEST(ChequerboardFactor, IterationsHardlyGrowWithTheNumberOfCells) {
  std::vector<int> iterations;
  for (const int n : {16, 24, 36}) {
    const Ball ball(n);
    Random random(2);
    Residual residual;
    residual.forces.assign(ball.at.positions.size(), Vec3::Zero());
    for (std::size_t c = 0; c < ball.model.tissue.cells.size(); ++c) residual.deficits.push_back(random.number());
    Direction direction;
    NewtonDirections::Cost cost;
    const auto status = make_directions(ball.model, LinearMethod::multigrid, {})
                            ->find(ball.step(), ball.at, residual, {false, 1e-5}, direction, cost);
    EXPECT_EQ(status, NewtonDirections::Status::found);
    iterations.push_back(cost.linear_solves);
  }
  EXPECT_LE(iterations.back(), iterations.front() + 1) << testing::PrintToString(iterations);
  EXPECT_LE(iterations.back(), 12) << testing::PrintToString(iterations);
}

// A cell all of whose nodes are held has no row; a node without stiffness has no place.
TEST(ChequerboardFactor, TakesCellsThatAreHeld) {
  Ball ball(8);
  for (const NodeId node : ball.model.tissue.elements[7]) ball.model.held[node.index()] = {true, true, true};
  const auto on_shell = ball.model.obstacles.front()->nodes();  // held nodes are never in contact
  for (std::size_t k = 0; k < on_shell.size(); ++k)
    if (ball.model.held[on_shell[k].index()][0]) ball.at.in_contact[k] = false;
  ball.frames = node_frames(ball.model, Contacts(ball.model), ball.at);
  StepMatrix matrix(ball.model);
  matrix.assemble(ball.model, Contacts(ball.model), ball.step(), ball.at);
  ChequerboardFactor factor(matrix.jacobian(), ball.frames.size());
  ASSERT_TRUE(factor.factorise(matrix.jacobian(), matrix, ball.frames));
  std::vector<double> rates(matrix.jacobian().sparse_rows(), 1.0);
  factor.solve(rates);
  for (const double pressure : rates) EXPECT_TRUE(std::isfinite(pressure));
  matrix.set_zero();
  EXPECT_FALSE(factor.factorise(matrix.jacobian(), matrix, ball.frames));
}

}  // namespace
}  // namespace plica
