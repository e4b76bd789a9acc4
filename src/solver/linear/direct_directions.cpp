#include "solver/linear/direct_directions.hpp"

#include <cmath>

namespace plica {

DirectDirections::DirectDirections(const Model& model)
    : model_(model), matrix_(model), linear_solver_(make_direct_solver()) {
  linear_solver_->analyse(matrix_.pattern());
}

bool DirectDirections::refresh(const Step& step, const Iterate& at) {
  factor_frames_ = node_frames(model_, at);
  factor_contacts_ = at.in_contact;
  factor_rate_s_ = step.rate_s;
  matrix_.assemble(model_, step, at);
  matrix_.write_values(factor_frames_, values_);
  made_from_ = factor_memory(step, at);
  if (linear_solver_->factorise(values_)) return true;
  forget_factor();
  return false;
}

void DirectDirections::recall(const FactorMemory& memory) {
  if (!memory.empty()) (void)refresh(step_of(memory), memory.at);
}

NewtonDirections::Outcome DirectDirections::find(const Step& step, const Iterate& at, const Residual& residual,
                                                 const Wish& wish, Direction& direction, Cost& cost) {
  // A factor of a step of nearly this length converges nearly as fast; of other contacts it has the wrong unknowns.
  constexpr double alike = 0.2;
  const bool stale =
      factor_frames_.empty() || std::abs(factor_rate_s_ / step.rate_s - 1) > alike || factor_contacts_ != at.in_contact;
  const bool slow = wish.left > 0.1;  // less than Newton's method can
  if (stale || slow) {
    ++cost.factorisations;
    if (!refresh(step, at)) return Outcome::singular;
  }
  ++cost.linear_solves;

  const std::size_t nodes = factor_frames_.size(), cells = matrix_.jacobian().cells();
  direction.positions.assign(at.positions.size(), Vec3::Zero());
  std::vector<double> unknowns(3 * nodes + cells, 0.0);
  for (std::size_t n = 0; n < nodes; ++n) {
    const Vec3 local = factor_frames_[n].axes.transpose() * residual.forces[n];
    for (int i = factor_frames_[n].fixed; i < 3; ++i) unknowns[3 * n + i] = local[i];
  }
  const std::span<double> of_cells = std::span(unknowns).subspan(3 * nodes);
  for (std::size_t c = 0; c < cells; ++c) of_cells[c] = -residual.volume_deficit[c];
  linear_solver_->solve(unknowns);

  for (std::size_t n = 0; n < nodes; ++n)
    direction.positions[n] = factor_frames_[n].axes * Vec3(unknowns[3 * n], unknowns[3 * n + 1], unknowns[3 * n + 2]);
  model_.tissue.place_hanging(direction.positions);
  direction.pressures.assign(of_cells.begin(), of_cells.end());
  direction.pressures.resize(at.pressures.size(), 0.0);
  return Outcome::found;
}

}  // namespace plica
