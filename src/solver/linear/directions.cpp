// Newton directions by a factor of the whole system, and the choice of the method for a model.
#include "solver/linear/directions.hpp"

#include <cmath>

#include "solver/linear/border.hpp"
#include "solver/linear/system_matrix.hpp"

namespace plica {
namespace {

/// Newton directions from a factor of the full indefinite system. The factor is reused, within a step and in the next
/// one of similar length with the same contacts, while it converges fast (docs/decisions/0003-newton.md).
class DirectDirections final : public NewtonDirections {
 public:
  explicit DirectDirections(const Model& model) : model_(model), contacts_(model) {}
  [[nodiscard]] Status find(const Step& step, const Iterate& at, const Residual& residual,
                            const ForcingTermInput& forcing, Direction& direction, Cost& cost) override {
    prepare(step);
    // A factor of a step of nearly this length converges nearly as fast; of other contacts it has the wrong unknowns.
    constexpr double alike = 0.2;
    const bool stale = factor_frames_.empty() || std::abs(factor_rate_s_ / step.rate_s - 1) > alike ||
                       factor_on_obstacle_ != at.on_obstacle;
    const bool slow = forcing.residual_reduction > 0.1;  // less than Newton's method can
    if (stale || slow) {
      ++cost.factorisations;
      if (!refresh(step, at)) return Status::singular;
    }
    ++cost.linear_solves;

    const ConstraintJacobian& J = matrix_->jacobian();
    const std::size_t nodes = factor_frames_.size(), sparse = J.sparse_rows();
    std::vector<double> unknowns(3 * nodes + J.rows(), 0.0);
    for (std::size_t n = 0; n < nodes; ++n) {
      const Vec3 local = factor_frames_[n].axes.transpose() * residual.forces[n];
      for (int i = factor_frames_[n].fixed; i < 3; ++i) unknowns[3 * n + i] = local[i];
    }
    const std::span<double> of_rows = std::span(unknowns).subspan(3 * nodes);
    for (std::size_t row = 0; row < J.rows(); ++row) of_rows[row] = -residual.deficits[J.multiplier(row)];
    const std::span<double> of_factor = std::span(unknowns).first(3 * nodes + sparse);
    linear_solver_->solve(of_factor);
    if (!dense_.empty()) dense_.apply(of_factor, of_rows.subspan(sparse));

    direction.positions.assign(at.positions.size(), Vec3::Zero());
    for (std::size_t n = 0; n < nodes; ++n)
      direction.positions[n] = factor_frames_[n].axes * Vec3(unknowns[3 * n], unknowns[3 * n + 1], unknowns[3 * n + 2]);
    model_.tissue.place_hanging(direction.positions);
    direction.multipliers.assign(at.multipliers.size(), 0.0);
    for (std::size_t row = 0; row < J.rows(); ++row) direction.multipliers[J.multiplier(row)] = of_rows[row];
    return Status::found;
  }
  void forget_factor() override { factor_frames_.clear(); }
  [[nodiscard]] bool keeps_factor() const override { return !factor_frames_.empty(); }

 private:
  // Laws may join other nodes than in the step before.
  void prepare(const Step& step) {
    if (matrix_ && matrix_->serves(model_, step)) return;
    forget_factor();
    matrix_ = std::make_unique<SystemMatrix>(model_, step, false);
    linear_solver_ = make_direct_solver();
    linear_solver_->analyse(matrix_->pattern());
  }
  bool refresh(const Step& step, const Iterate& at) {
    factor_frames_ = node_frames(model_, contacts_, at);
    factor_on_obstacle_ = at.on_obstacle;
    factor_rate_s_ = step.rate_s;
    matrix_->assemble(model_, contacts_, step, at);
    matrix_->write_values(factor_frames_, values_);
    if (!linear_solver_->factorise(values_)) {
      forget_factor();
      return false;
    }
    border_dense_rows();
    return true;
  }
  // Unknowns of the factor: three a free node, in its frame, then one a sparse row of J.
  void border_dense_rows() {
    const ConstraintJacobian& J = matrix_->jacobian();
    const std::size_t nodes = factor_frames_.size();
    std::vector<std::vector<double>> rows(J.dense_rows(), std::vector<double>(3 * nodes + J.sparse_rows(), 0.0));
    for (std::size_t row = 0; row < rows.size(); ++row)
      for (std::size_t n = 0; n < nodes; ++n) {
        const Vec3 local = factor_frames_[n].axes.transpose() * J.dense_row(row)[n];
        for (int i = factor_frames_[n].fixed; i < 3; ++i) rows[row][3 * n + i] = local[i];
      }
    dense_.begin(std::move(rows), [&](std::span<double> x) { linear_solver_->solve(x); });
  }

  const Model& model_;
  ObstacleContacts contacts_;
  std::unique_ptr<SystemMatrix> matrix_;  // for the last patterns of the laws
  std::unique_ptr<LinearSolver> linear_solver_;
  DenseBorder dense_;
  std::vector<double> values_;

  // Step::rate_s and frames of the present factor. Empty frames: no factor.
  std::vector<NodeFrame> factor_frames_;
  std::vector<char> factor_on_obstacle_;
  double factor_rate_s_ = 0;
};

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

  // The factor of the direct method is used for one step only.
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
  // room than a usual machine has (docs/decisions/0015-speed.md). Multigrid finds the long thin elements of
  // divided cells hard.
  constexpr std::size_t most_nodes_of_cholesky = 20'000, most_nodes_when_divided = 50'000,
                        most_nodes_of_direct = 60'000;
  const std::size_t nodes = model.tissue.free_node_count();
  const bool is_divided = !model.tissue.hanging.empty();
  const bool is_large = nodes > (is_divided ? most_nodes_when_divided : most_nodes_of_cholesky);
  if (method == LinearMethod::automatic) method = is_large ? LinearMethod::multigrid : LinearMethod::cholesky;
  if (method == LinearMethod::direct) return std::make_unique<DirectDirections>(model);
  auto krylov = make_krylov_directions(model, method, std::move(stop_requested));
  if (nodes > most_nodes_of_direct) return krylov;
  return std::make_unique<GuardedDirections>(model, std::move(krylov));
}

}  // namespace plica
