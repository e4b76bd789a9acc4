// Newton directions by conjugate residuals with products of the laws: the system (linearised_step.hpp) is matrix-free;
// only its preconditioner (kept_preconditioner.hpp) is assembled, and reused over steps.
#pragma once

#include "solver/algebra/krylov.hpp"
#include "solver/linear/directions.hpp"
#include "solver/linear/kept_preconditioner.hpp"

namespace plica {

class KrylovDirections final : public NewtonDirections {
 public:
  using Inverse = KeptPreconditioner::Inverse;

  KrylovDirections(const Model& model, Inverse inverse, std::function<bool()> stop_requested);
  [[nodiscard]] Status find(const Step& step, const Iterate& at, const Residual& residual,
                            const ForcingTermInput& forcing, Direction& direction, Cost& cost) override;
  void forget_factor() override { is_made_ = false; }
  [[nodiscard]] bool keeps_factor() const override { return is_made_ && wasted_iterations_ <= price_of_new_; }

 private:
  /// Take new patterns: the preconditioner stays in use while it is good.
  void fit_pattern(const Step& step);
  /// Return the iterations of a solve that a new preconditioner would have saved.
  [[nodiscard]] int wasted(const KrylovReport& solve) const;

  const Model& model_;
  std::function<bool()> stop_requested_;
  Inverse inverse_;
  LinearisedStep system_;
  std::unique_ptr<KeptPreconditioner> kept_;  // for the patterns at its computation
  bool is_made_ = false;
  int price_of_new_;             // cost of a new one, in iterations, including assembly
  int iterations_when_new_ = 0;  // to 1e-4
  int wasted_iterations_ = 0;
  ConjugateResiduals solver_;
};

}  // namespace plica
