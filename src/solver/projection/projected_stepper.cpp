#include "solver/projection/projected_stepper.hpp"

#include "solver/step/backward_difference.hpp"

namespace plica {

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
