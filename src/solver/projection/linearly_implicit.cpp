#include "solver/projection/linearly_implicit.hpp"

#include "solver/algebra/conjugate_gradients.hpp"

namespace plica {
namespace {

/// The 3 x 3 blocks on the diagonal of a tangent.
struct DiagonalBlocks final : TangentSink {
  explicit DiagonalBlocks(std::size_t nodes) : blocks(nodes, Mat3::Zero()) {}
  void add_block(NodeId row, NodeId column, const Mat3& block) override {
    if (row == column) blocks[row.index()] += block;
  }
  std::vector<Mat3> blocks;
};

}  // namespace

LinearlyImplicit::LinearlyImplicit(const Model& model, double tolerance, int most_iterations)
    : model_(model), tolerance_(tolerance), most_iterations_(most_iterations) {}

void LinearlyImplicit::keep_held(Vectors& vectors) const {
  for (std::size_t n = 0; n < vectors.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model_.held[n][axis]) vectors[n][axis] = 0;
}

StepReport LinearlyImplicit::advance(const State& state, double duration_s, bool /*from_rest*/, State& next) {
  const std::size_t nodes = state.positions.size();
  Step step{state.positions, state.positions, state.velocities, duration_s, state.time_s + duration_s};
  step.semidefinite_tangent = true;
  StepReport report;
  Vectors forces(nodes, Vec3::Zero());
  for (const auto& law : model_.laws) law->add_forces(step, forces);
  keep_held(forces);

  DiagonalBlocks diagonal(nodes);
  for (const auto& law : model_.laws) law->add_tangent(step, diagonal);
  for (std::size_t n = 0; n < nodes; ++n) {
    Mat3& block = diagonal.blocks[n];
    for (int axis = 0; axis < 3; ++axis)
      if (model_.held[n][axis]) {
        block.row(axis).setZero();
        block.col(axis).setZero();
        block(axis, axis) = 1;
      }
    block = block.inverse().eval();
  }

  const auto multiply = [&](const Vectors& direction, Vectors& product) {
    product.assign(nodes, Vec3::Zero());
    for (const auto& law : model_.laws) law->add_tangent_product(step, direction, product);
    keep_held(product);
  };
  const auto precondition = [&](const Vectors& residual, Vectors& result) {
    for (std::size_t n = 0; n < nodes; ++n) result[n] = diagonal.blocks[n] * residual[n];
  };
  Vectors displacements;
  const ConjugateGradientsReport solved =
      conjugate_gradients(multiply, precondition, forces, tolerance_, most_iterations_, stop_requested_, displacements);
  report.newton_iterations = 1;
  report.linear_solves = solved.iterations;
  report.residual = solved.residual;
  if (!solved.converged) {
    report.outcome = solved.interrupted               ? StepReport::Outcome::interrupted
                     : std::isfinite(solved.residual) ? StepReport::Outcome::no_linear_convergence
                                                      : StepReport::Outcome::not_finite;
    report.cell = cell_with_largest(model_.tissue, forces);
    return report;
  }

  next.positions = state.positions;
  for (std::size_t n = 0; n < nodes; ++n) next.positions[n] += displacements[n];
  next.time_s = state.time_s + duration_s;
  next.pressures.assign(state.pressures.size(), 0.0);
  next.contact_forces.assign(state.contact_forces.size(), 0.0);
  next.in_contact.assign(state.in_contact.size(), 0);
  record_motion(state, duration_s, TimeOrder::first, next);
  report.outcome = StepReport::Outcome::converged;
  return report;
}

}  // namespace plica
