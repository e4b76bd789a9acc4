// Time stepping of the paper (2.5, 2.7). Theory: docs/developers/paper-algorithm.md.
#pragma once

#include "solver/algebra/krylov.hpp"
#include "solver/projection/volume_projection.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// Force step of the paper (2.7): linearised backward Euler, one linear system solved by conjugate gradients, no global
/// matrix. Solves  A dx = f(x^n),  A = D/h + M/h^2 + K~,  with the semidefinite tangent K~ of the
/// laws, to a residual of `tolerance` times |f|. Preconditioned by the inverse 3 x 3 diagonal blocks of A. The step
/// fails after `most_iterations`.
class LinearlyImplicit final : public Stepper {
 public:
  LinearlyImplicit(const Model& model, double tolerance, int most_iterations);

  StepReport advance(const State& state, double duration_s, bool from_rest, State& next,
                     const Model* grown = nullptr) override;
  void stop_when(std::function<bool()> stop_requested) override { stop_requested_ = std::move(stop_requested); }

 private:
  void keep_held(std::span<Vec3> vectors) const;  // sets held directions to zero
  KrylovReport solve(const Step& step, const KrylovVector& forces, KrylovVector& displacements) const;

  const Model& model_;
  double tolerance_;
  int most_iterations_;
  std::function<bool()> stop_requested_;
};

/// Force step followed by projection onto volumes and obstacles: the splitting of the paper (2.5, 2.7).
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
