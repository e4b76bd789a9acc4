// Force step of the paper (2.7): linearised backward Euler, one linear system solved by conjugate gradients, no global
// matrix. Volumes and the shell are projected afterwards (projected_stepper.hpp). Theory:
// docs/theory/paper_algorithm.md.
#pragma once

#include "solver/step/stepper.hpp"

namespace plica {

/// Linearly implicit stepper. Solves  A dx = f(x^n),  A = D/h + M/h^2 + K~,  with the semidefinite tangent K~ of the
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

  const Model& model_;
  double tolerance_;
  int most_iterations_;
  std::function<bool()> stop_requested_;
};

}  // namespace plica
