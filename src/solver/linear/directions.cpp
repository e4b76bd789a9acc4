// Choice of the method for Newton directions of a model.
#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/direct_directions.hpp"
#include "solver/linear/krylov_directions.hpp"

namespace plica {
namespace {

// Krylov method, with the direct one if it fails: far from equilibrium, or without a stable one, no positive definite
// matrix is near the tangent.
class GuardedDirections final : public NewtonDirections {
 public:
  GuardedDirections(const Model& model, std::unique_ptr<NewtonDirections> first)
      : model_(model), first_(std::move(first)) {}

  Status find(const Step& step, const Iterate& at, const Residual& residual, const ForcingTermInput& forcing,
              Direction& direction, Cost& cost) override {
    if (gave_up_at_s_ != step.end_time_s) {
      const Status status = first_->find(step, at, residual, forcing, direction, cost);
      if (status != Status::singular) return status;
      gave_up_at_s_ = step.end_time_s;
      if (!second_) second_ = std::make_unique<DirectDirections>(model_);
      second_->forget_factor();
    }
    return second_->find(step, at, residual, forcing, direction, cost);
  }

  void forget_factor() override {
    first_->forget_factor();
    second_.reset();
    gave_up_at_s_ = -1;
  }

  // The second's factor serves one step only.
  [[nodiscard]] bool keeps_factor() const override { return first_->keeps_factor(); }

 private:
  const Model& model_;
  std::unique_ptr<NewtonDirections> first_, second_;
  double gave_up_at_s_ = -1;  // end of the step that is left to the direct method
};

}  // namespace

std::unique_ptr<NewtonDirections> make_directions(const Model& model, LinearMethod method,
                                                  std::function<bool()> stop_requested) {
  // Sizes at which the factor of a sheet takes as long as multigrid, and where that of the indefinite system takes more
  // room than a usual machine has (docs/developers/performance-notebook.md). Multigrid finds the long thin elements of
  // divided cells hard.
  constexpr std::size_t most_nodes_of_cholesky = 20'000, most_nodes_when_divided = 50'000,
                        most_nodes_of_direct = 60'000;
  const std::size_t nodes = model.tissue.free_node_count();
  const bool is_divided = !model.tissue.hanging.empty();
  const bool is_large = nodes > (is_divided ? most_nodes_when_divided : most_nodes_of_cholesky);
  if (method == LinearMethod::automatic) method = is_large ? LinearMethod::multigrid : LinearMethod::cholesky;
  if (method == LinearMethod::direct) return std::make_unique<DirectDirections>(model);
  const auto inverse =
      method == LinearMethod::multigrid ? KrylovDirections::Inverse::multigrid : KrylovDirections::Inverse::cholesky;
  auto krylov = std::make_unique<KrylovDirections>(model, inverse, std::move(stop_requested));
  if (nodes > most_nodes_of_direct) return krylov;
  return std::make_unique<GuardedDirections>(model, std::move(krylov));
}

}  // namespace plica
