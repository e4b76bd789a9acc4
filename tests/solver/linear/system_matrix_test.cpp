// The matrix of a step, and directions of Newton's method by every way of solving with it.
#include "solver/linear/system_matrix.hpp"

#include "core/parallel.hpp"
#include "core/threads.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/border.hpp"
#include "solver/linear/chequerboard_factor.hpp"
#include "solver/linear/directions.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace {

std::vector<double> volume_rates(const SystemMatrix& matrix, const Vectors& direction) {
  std::vector<double> rates(matrix.jacobian().sparse_rows());
  matrix.jacobian().rates(direction, rates);
  return rates;
}

TEST(SystemMatrix, ProductIsTheSumOfTheLawsMatrixFreeProducts) {
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 2, 1}, {1, 2, 2}}) {
    const Model model = dimpling_sheet(elements);
    const Motion motion = random_motion(model.tissue, 2, 1);
    Random random(2);
    std::vector<double> pressures;
    for (std::size_t c = 0; c < model.volumes.count(); ++c) pressures.push_back(random.number());

    SystemMatrix matrix(model);
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

TEST(SystemMatrix, VolumeRatesAreTheDerivativesOfTheVolumes) {
  const Model model = dimpling_sheet({2, 2, 1});
  Motion motion = random_motion(model.tissue, 2, 4);
  SystemMatrix matrix(model);
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

TEST(SystemMatrix, PressureForcesAreThoseOfTheVolumes) {
  const Model model = dimpling_sheet({1, 1, 2});
  const Motion motion = random_motion(model.tissue, 2, 5);
  SystemMatrix matrix(model);
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
TEST(SystemMatrix, PressureForcesAreTheSameBitsOnOneAndTwoThreads) {
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
TEST(SystemMatrix, WrittenValuesAreTheFramedSystem) {
  const Model model = dimpling_sheet();
  const Motion motion = random_motion(model.tissue, 2, 8);
  SystemMatrix matrix(model);
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
  const SparsePattern pattern = matrix.pattern();
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
TEST(SystemMatrix, AFixedUnknownWithoutStiffnessHasAPivot) {
  Model model(build_block({.cells = {1, 1, 1}}));
  model.volumes.hold(false);
  SystemMatrix matrix(model);
  matrix.set_zero();
  std::vector<NodeFrame> frames(model.tissue.node_count());
  for (NodeFrame& frame : frames) frame.fixed = 3;
  std::vector<double> values;
  matrix.write_values(frames, values);
  const SparsePattern pattern = matrix.pattern();
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
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue&, const TissueChange&,
                                                  std::span<const Vec3>) const override {
    return clone();
  }
};

TEST(SystemMatrix, ABlockOutsideThePatternIsAnErrorThatNamesTheLaw) {
  Model model = dimpling_sheet();
  model.laws.push_back(std::make_unique<Liar>());
  SystemMatrix matrix(model);
  const State rest = rest_state(model);
  const Iterate at{rest.positions, rest.multipliers, rest.obstacle_forces, rest.on_obstacle};
  const Step step{rest.positions, rest.positions, rest.velocities, 1, 1};
  EXPECT_SAYS(error_of<std::logic_error>([&] { matrix.assemble(model, ObstacleContacts(model), step, at); }), "liar");
}

/// A ball of n x n squares a face, all cells of the same size, at rest, every third apical node free of the shell.
struct Ball {
  explicit Ball(int n) : model(build_shell({.length_um = 35.0 * n, .diameter_um = 35.0 * n, .cells = {n, n, n}})) {
    add_elasticity(model);
    add_drag(model, 0.1);
    model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
    const State rest = rest_state(model);
    at = {rest.positions, rest.multipliers, rest.obstacle_forces, rest.on_obstacle};
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k) at.on_obstacle[k] = k % 3 != 0;
    frames = node_frames(model, ObstacleContacts(model), at);
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
  SystemMatrix matrix(ball.model);
  matrix.assemble(ball.model, ObstacleContacts(ball.model), ball.step(), ball.at);
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
    if (ball.model.held[on_shell[k].index()][0]) ball.at.on_obstacle[k] = false;
  ball.frames = node_frames(ball.model, ObstacleContacts(ball.model), ball.at);
  SystemMatrix matrix(ball.model);
  matrix.assemble(ball.model, ObstacleContacts(ball.model), ball.step(), ball.at);
  ChequerboardFactor factor(matrix.jacobian(), ball.frames.size());
  ASSERT_TRUE(factor.factorise(matrix.jacobian(), matrix, ball.frames));
  std::vector<double> rates(matrix.jacobian().sparse_rows(), 1.0);
  factor.solve(rates);
  for (const double pressure : rates) EXPECT_TRUE(std::isfinite(pressure));
  matrix.set_zero();
  EXPECT_FALSE(factor.factorise(matrix.jacobian(), matrix, ball.frames));
}

/// An iterate somewhat off balance, with some nodes on the shell, and its residual.
struct Case {
  explicit Case(const Model& m, unsigned seed = 1) : model(m), random(seed) {
    const State rest = rest_state(model);
    at = {rest.positions, rest.multipliers, rest.obstacle_forces, rest.on_obstacle};
    previous = rest.positions;
    const Vectors moves = random.vectors(previous.size());
    for (std::size_t n = 0; n < moves.size(); ++n) at.positions[n] += 0.2 * moves[n];
    model.tissue.place_hanging(at.positions);
    for (double& pressure : at.multipliers) pressure = 0.02 * random.number();
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k) at.on_obstacle[k] = k % 3 != 0;
    return_to_obstacles(model, ObstacleContacts(model), at);
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k) at.obstacle_forces[k] = at.on_obstacle[k] ? 0.5 : 0;
    residual.forces = random.vectors(previous.size());
    for (std::size_t n = model.tissue.free_node_count(); n < previous.size(); ++n) residual.forces[n].setZero();
    for (std::size_t c = 0; c < at.multipliers.size(); ++c) residual.deficits.push_back(random.number());
  }
  [[nodiscard]] Step step() const { return {at.positions, previous, velocities, 5, 5}; }
  [[nodiscard]] Direction direction(LinearMethod method) const {
    Direction found;
    NewtonDirections::Cost cost;
    const auto status = make_directions(model, method, {})->find(step(), at, residual, {0, 1e-5}, found, cost);
    EXPECT_EQ(status, NewtonDirections::Status::found);
    EXPECT_GE(cost.factorisations, 1);
    EXPECT_GE(cost.linear_solves, 1);
    return found;
  }

  const Model& model;
  Random random;
  Iterate at;
  Residual residual;
  Vectors previous, velocities = Vectors(previous.size(), Vec3::Zero());
};

TEST(NewtonDirections, AreTheSameWhicheverWayTheyAreFound) {
  std::vector<Model> models;
  models.push_back(dimpling_sheet());
  models.push_back(dimpling_sheet({2, 1, 2}));
  models.push_back(dimpling_sheet());
  models.back().volumes.hold(false);
  models.push_back(dimpling_sheet());
  for (std::size_t n = 0; n < 8; ++n) models.back().held[n] = {true, n % 2 == 0, false};
  models.push_back(furrowing_sphere());
  for (const Model& model : models) {
    const Case given(model);
    const Direction direct = given.direction(LinearMethod::direct);
    for (const LinearMethod method : {LinearMethod::cholesky, LinearMethod::multigrid, LinearMethod::automatic}) {
      const Direction found = given.direction(method);
      EXPECT_LE(largest_distance(found.positions, direct.positions), 1e-3 * largest(direct.positions));
      ASSERT_EQ(found.multipliers.size(), direct.multipliers.size());
      const Eigen::Map<const Eigen::VectorXd> p(found.multipliers.data(), found.multipliers.size()),
          q(direct.multipliers.data(), direct.multipliers.size());
      EXPECT_LE((p - q).norm(), 1e-3 * q.norm());
    }
  }
}

// Made where drag is all there is, it is of little use for the elastic sheet.
TEST(NewtonDirections, AMultigridThatDragsASolveOutIsMadeAnewOnTheWay) {
  const Model model = dimpling_sheet({2, 2, 2});
  const Case given(model);
  const auto directions = make_directions(model, LinearMethod::multigrid, {});
  const auto find = [&](double rate_s, Direction& found) {
    Step step = given.step();
    step.rate_s = rate_s;
    NewtonDirections::Cost cost;
    EXPECT_EQ(directions->find(step, given.at, given.residual, {0, 1e-5}, found, cost),
              NewtonDirections::Status::found);
    return cost;
  };
  Direction found;
  EXPECT_EQ(find(1e-4, found).factorisations, 1);
  const auto cost = find(given.step().rate_s, found);
  EXPECT_EQ(cost.factorisations, 1);
  EXPECT_GT(cost.linear_solves, 15) << "it should have been tried";
  EXPECT_LT(cost.linear_solves, 60);
  const Direction expected = given.direction(LinearMethod::direct);
  EXPECT_LE(largest_distance(found.positions, expected.positions), 1e-3 * largest(expected.positions));
}

// A sheet that is pressed together in its plane so much that it would rather buckle.
TEST(NewtonDirections, FarFromBalanceTheSemidefiniteTangentShowsTheWayOutOfInstability) {
  Model model = dimpling_sheet({2, 2, 2});
  model.obstacles.clear();
  Case given(model);
  given.at.positions = given.previous;
  for (Vec3& position : given.at.positions) position.head<2>() *= 0.9;
  // The part of the forces that a direction leaves, by all of the tangent or its semidefinite part.
  SystemMatrix matrix(model);
  const auto left = [&](const Direction& found, bool semidefinite) {
    Step step = given.step();
    step.semidefinite_tangent = semidefinite;
    matrix.assemble(model, ObstacleContacts(model), step, given.at);
    ConstraintJacobian jacobian(model);
    jacobian.update(model, given.at.positions);
    Vectors rest = product_of(matrix, found.positions);
    rest.resize(found.positions.size(), Vec3::Zero());
    jacobian.add_forces(found.multipliers, -1, rest);
    for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= given.residual.forces[n];
    return std::sqrt(parallel_squared_norm(rest) / parallel_squared_norm(given.residual.forces));
  };
  for (const LinearMethod method : {LinearMethod::cholesky, LinearMethod::multigrid}) {
    given.residual.force = 0.5;
    const Direction far = given.direction(method);
    EXPECT_LE(left(far, true), 1e-2);
    EXPECT_GE(left(far, false), 0.1);
    // Near it all of the tangent is used, though 200 iterations do not solve that system to what was asked for.
    given.residual.force = 0.05;
    const Direction near = given.direction(method);
    EXPECT_LE(left(near, false), 0.05);
    EXPECT_GE(left(near, true), 0.1);
  }
}

TEST(NewtonDirections, EveryWayLeadsToTheSameState) {
  const Model model = furrowing_sphere();
  std::vector<State> ends;
  for (const LinearMethod method :
       {LinearMethod::direct, LinearMethod::cholesky, LinearMethod::multigrid, LinearMethod::automatic}) {
    NewtonStepper solver(model, {}, method);
    State state = rest_state(model), next;
    for (int k = 0; k < 5; ++k) {
      ASSERT_TRUE(solver.advance(state, 5, k == 0, next).converged());
      std::swap(state, next);
    }
    ends.push_back(state);
    EXPECT_LE(largest_distance(state.positions, ends.front().positions), 1e-6);
    EXPECT_EQ(state.on_obstacle, ends.front().on_obstacle);
  }
}

// Nodes leave the shell and others come to it: factor and border are the inverse of the new matrix.
TEST(ObstacleBorder, SolvesForTheContactsOfNow) {
  const Model model = furrowing_sphere();
  Case given(model);
  SystemMatrix matrix(model);
  Step step = given.step();
  step.semidefinite_tangent = true;
  matrix.assemble(model, ObstacleContacts(model), step, given.at);
  const auto factor = [&](const Iterate& at) {
    auto cholesky = std::make_unique<BlockCholesky>(matrix.layout());
    UninitialisedVector<float> values;
    matrix.write_projected_blocks(node_frames(model, ObstacleContacts(model), at), values);
    EXPECT_TRUE(cholesky->factorise(values));
    return cholesky;
  };
  const auto before = factor(given.at);
  const ObstacleContacts contacts(model);
  ObstacleBorder border;
  border.begin(model, contacts, matrix, node_frames(model, ObstacleContacts(model), given.at), given.at.on_obstacle,
               32);

  Iterate now = given.at;
  int changes = 0;
  for (std::size_t k = 0; k < now.on_obstacle.size(); k += 17, ++changes) now.on_obstacle[k] ^= 1;
  ASSERT_GT(changes, 20);
  ASSERT_TRUE(border.follow(now, *before));
  const auto after = factor(now);
  const std::vector<NodeFrame> frames = node_frames(model, ObstacleContacts(model), now);
  Vectors x = given.random.vectors(frames.size());
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = frames[n].free_part(x[n]);
  std::vector<float> expected;
  for (const Vec3& v : x) expected.insert(expected.end(), {float(v.x()), float(v.y()), float(v.z())});
  const Vectors forces = x;
  border.solve(*before, x);
  after->solve(expected);
  double difference = 0, without = 0, length = 0;
  Vectors alone = forces;
  border.begin(model, contacts, matrix, node_frames(model, ObstacleContacts(model), given.at), given.at.on_obstacle,
               32);
  border.solve(*before, alone);
  for (std::size_t n = 0; n < x.size(); ++n) {
    const Vec3 should_be(expected[3 * n], expected[3 * n + 1], expected[3 * n + 2]);
    difference += (frames[n].free_part(x[n]) - should_be).squaredNorm();
    without += (frames[n].free_part(alone[n]) - should_be).squaredNorm();
    length += should_be.squaredNorm();
  }
  EXPECT_LE(std::sqrt(difference / length), 1e-4);
  EXPECT_GE(std::sqrt(without / length), 1e-2) << "the changes should matter";
}

// A factor of a case, and its border before any contact has changed.
struct Bordered {
  explicit Bordered(const Case& given, const Model& model) : contacts(model), matrix(model), factor(matrix.layout()) {
    matrix.assemble(model, ObstacleContacts(model), given.step(), given.at);
    UninitialisedVector<float> values;
    matrix.write_projected_blocks(node_frames(model, ObstacleContacts(model), given.at), values);
    EXPECT_TRUE(factor.factorise(values));
    border.begin(model, contacts, matrix, node_frames(model, ObstacleContacts(model), given.at), given.at.on_obstacle,
                 32);
  }
  ObstacleContacts contacts;
  SystemMatrix matrix;
  BlockCholesky factor;
  ObstacleBorder border;
};

TEST(ObstacleBorder, TakesUpOnlySoManyChanges) {
  const Model model = furrowing_sphere();
  const Case given(model);
  Bordered now(given, model);
  Iterate changed = given.at;
  for (char& contact : changed.on_obstacle) contact ^= 1;
  EXPECT_FALSE(now.border.follow(changed, now.factor));
}

}  // namespace
