// Newton directions by conjugate residuals on the products of the laws: the system (linearised_step.hpp) is not
// assembled, only what preconditions it (kept_preconditioner.hpp), and that serves over steps.
#pragma once

#include "solver/algebra/conjugate_residuals.hpp"
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
  [[nodiscard]] FactorMemory memory() const override;
  void recall(const FactorMemory& memory) override;

 private:
  /// Laws may join other nodes than when the preconditioner was made; it serves on while it is good.
  void fit_pattern(const Step& step);
  /// How many of a solve's iterations a new preconditioner would have saved.
  [[nodiscard]] int wasted(const KrylovReport& solve) const;

  const Model& model_;
  std::function<bool()> stop_requested_;
  Inverse inverse_;
  LinearisedStep system_;
  std::unique_ptr<KeptPreconditioner> kept_;  // of the laws' patterns when it was made
  bool is_made_ = false;
  int price_of_new_;             // in iterations that take as long, with the assembly
  int iterations_when_new_ = 0;  // to 1e-4
  int wasted_iterations_ = 0;
  ConjugateResiduals solver_;
};

}  // namespace plica
