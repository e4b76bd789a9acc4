#include "solver/projection/projected_stepper.hpp"

#include <algorithm>
#include <cmath>

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

std::span<Vec3> as_vectors(KrylovVector& vector) { return {reinterpret_cast<Vec3*>(vector.data()), vector.size() / 3}; }
std::span<const Vec3> as_vectors(const KrylovVector& vector) {
  return {reinterpret_cast<const Vec3*>(vector.data()), vector.size() / 3};
}

/// Inverses of these blocks of the tangent of all laws, held directions replaced by the identity.
std::vector<Mat3> inverse_diagonal(const Model& model, const Step& step) {
  DiagonalBlocks diagonal(step.positions.size());
  for_laws(model, step, [&](const Law& law, const Step& law_step) { law.add_tangent(law_step, diagonal); });
  for (std::size_t n = 0; n < diagonal.blocks.size(); ++n) {
    Mat3& block = diagonal.blocks[n];
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        block.row(axis).setZero();
        block.col(axis).setZero();
        block(axis, axis) = 1;
      }
    block = block.inverse().eval();
  }
  return std::move(diagonal.blocks);
}

}  // namespace

LinearlyImplicit::LinearlyImplicit(const Model& model, double tolerance, int most_iterations)
    : model_(model), tolerance_(tolerance), most_iterations_(most_iterations) {}

void LinearlyImplicit::keep_held(std::span<Vec3> vectors) const {
  for (std::size_t n = 0; n < vectors.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model_.held[n][axis]) vectors[n][axis] = 0;
}

StepReport LinearlyImplicit::advance(const State& state, double duration_s, bool /*from_rest*/, State& next,
                                     const Model* grown) {
  Step step{state.positions, state.positions, state.velocities, duration_s, state.time_s + duration_s};
  step.semidefinite_tangent = true;
  step.internals = state.internals;
  step.grown = grown;
  KrylovVector forces(3 * state.positions.size(), 0.0), displacements;
  for_laws(model_, step, [&](const Law& law, const Step& law_step) { law.add_forces(law_step, as_vectors(forces)); });
  keep_held(as_vectors(forces));
  const KrylovReport solved = solve(step, forces, displacements);
  StepReport report;
  report.newton_iterations = 1;
  report.linear_solves = solved.iterations;
  report.residual = solved.residual;
  if (!solved.converged) {
    report.status = solved.interrupted               ? StepReport::Status::interrupted
                    : std::isfinite(solved.residual) ? StepReport::Status::no_linear_convergence
                                                     : StepReport::Status::not_finite;
    report.cell = cell_with_largest(model_.tissue, as_vectors(forces));
    return report;
  }
  next.positions = state.positions;
  for (std::size_t n = 0; n < next.positions.size(); ++n) next.positions[n] += as_vectors(displacements)[n];
  next.time_s = state.time_s + duration_s;
  next.multipliers.assign(state.multipliers.size(), 0.0);
  next.obstacle_forces.assign(state.obstacle_forces.size(), 0.0);
  next.on_obstacle.assign(state.on_obstacle.size(), 0);
  step.positions = next.positions;
  next.internals = next_internals(model_, step);
  record_motion(state, duration_s, TimeOrder::first, next);
  report.status = StepReport::Status::converged;
  return report;
}

KrylovReport LinearlyImplicit::solve(const Step& step, const KrylovVector& forces, KrylovVector& displacements) const {
  const auto multiply = [&](const KrylovVector& direction, KrylovVector& product) {
    std::ranges::fill(product, 0.0);
    for_laws(model_, step, [&](const Law& law, const Step& law_step) {
      law.add_tangent_product(law_step, as_vectors(direction), as_vectors(product));
    });
    keep_held(as_vectors(product));
  };
  const std::vector<Mat3> inverse = inverse_diagonal(model_, step);
  const auto precondition = [&](const KrylovVector& residual, KrylovVector& result) {
    for (std::size_t n = 0; n < inverse.size(); ++n) as_vectors(result)[n] = inverse[n] * as_vectors(residual)[n];
  };
  return conjugate_gradients(
      multiply, precondition, forces, {.tolerance = tolerance_, .most_iterations = most_iterations_},
      [&](const KrylovReport&) { return !(stop_requested_ && stop_requested_()); }, displacements);
}

ProjectedStepper::ProjectedStepper(const Model& model, std::unique_ptr<Stepper> force_step,
                                   const std::optional<ProjectionRule>& rule)
    : model_(model), force_step_(std::move(force_step)), projection_(model, rule) {}

void ProjectedStepper::stop_when(std::function<bool()> stop_requested) {
  stop_requested_ = stop_requested;
  force_step_->stop_when(std::move(stop_requested));
}

StepReport ProjectedStepper::advance(const State& state, double duration_s, bool from_rest, State& next,
                                     const Model* grown) {
  State moved;
  StepReport report = force_step_->advance(state, duration_s, from_rest, moved, grown);
  if (!report.converged()) return report;
  moved.multipliers.assign(state.multipliers.size(), 0.0);  // none of its own
  projection_.apply(state, duration_s, stop_requested_, moved, report);
  if (!report.converged()) return report;
  if (const auto inverted = inverted_cell(model_.tissue, moved.positions)) {
    report.status = StepReport::Status::inverted_element;
    report.cell = inverted;
    return report;
  }
  record_motion(state, duration_s, TimeOrder::first, moved);  // of the whole step
  Step step{moved.positions, state.positions, state.velocities, duration_s, moved.time_s};
  step.internals = state.internals;
  step.grown = grown;
  moved.internals = next_internals(model_, step);
  next = std::move(moved);
  return report;
}

}  // namespace plica
