#include "solver/linear/chequerboard_factor.hpp"

#include <gtest/gtest.h>

#include "mechanics/obstacles/vitelline.hpp"
#include "solver/linear/directions.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

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
