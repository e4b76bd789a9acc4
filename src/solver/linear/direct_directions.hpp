// Newton directions from a factor of the full indefinite system. The factor is reused, within a step and in the next
// one of similar length with the same contacts, while it converges fast (docs/decisions/0003-newton.md).
#pragma once

#include "solver/linear/dense_border.hpp"
#include "solver/linear/directions.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

class DirectDirections final : public NewtonDirections {
 public:
  explicit DirectDirections(const Model& model);
  [[nodiscard]] Status find(const Step& step, const Iterate& at, const Residual& residual,
                            const ForcingTermInput& forcing, Direction& direction, Cost& cost) override;
  void forget_factor() override { factor_frames_.clear(); }
  [[nodiscard]] bool keeps_factor() const override { return !factor_frames_.empty(); }

 private:
  void prepare(const Step& step);
  bool refresh(const Step& step, const Iterate& at);
  void border_dense_rows();

  const Model& model_;
  Contacts contacts_;
  std::unique_ptr<StepMatrix> matrix_;  // for the last patterns of the laws
  std::unique_ptr<LinearSolver> linear_solver_;
  DenseBorder dense_;
  std::vector<double> values_;

  // Step::rate_s and frames of the present factor. Empty frames: no factor.
  std::vector<NodeFrame> factor_frames_;
  std::vector<char> factor_contacts_;
  double factor_rate_s_ = 0;
};

}  // namespace plica
