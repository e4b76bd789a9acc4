// Force step followed by projection onto volumes and obstacles: the splitting of the paper (2.5, 2.7).
#pragma once

#include "solver/projection/volume_projection.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

class ProjectedStepper final : public Stepper {
 public:
  /// Make the stepper; without a rule only obstacles are enforced.
  ProjectedStepper(const Model& model, std::unique_ptr<Stepper> force_step, const std::optional<ProjectionRule>& rule);

  StepReport advance(const State& state, double duration_s, bool from_rest, State& next,
                     const Model* grown = nullptr) override;
  void stop_when(std::function<bool()> stop_requested) override;
  void forget_factor() override { force_step_->forget_factor(); }
  [[nodiscard]] bool keeps_factor() const override { return force_step_->keeps_factor(); }

 private:
  const Model& model_;
  std::unique_ptr<Stepper> force_step_;
  VolumeProjection projection_;
  std::function<bool()> stop_requested_;
};

}  // namespace plica
