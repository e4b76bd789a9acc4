#include "solver/linear/dense_border.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace plica {

void DenseBorder::begin(std::vector<std::vector<double>> rows, const std::function<void(std::span<double>)>& solve) {
  rows_ = std::move(rows);
  columns_ = rows_;
  const auto count = static_cast<Eigen::Index>(rows_.size());
  Eigen::MatrixXd complement(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    solve(columns_[j]);
    for (Eigen::Index i = 0; i < count; ++i) complement(i, j) = parallel_dot(rows_[i], columns_[j]);
  }
  // A row already implied by K (the total volume of all cells) gets no multiplier: its remainder is the error of the
  // inverse.
  constexpr double nothing_left = 1e-6;
  active_.clear();
  for (Eigen::Index i = 0; i < count; ++i) {
    const double sizes = std::sqrt(parallel_dot(rows_[i], rows_[i]) * parallel_dot(columns_[i], columns_[i]));
    if (complement(i, i) > nothing_left * sizes) active_.push_back(i);
  }
  if (!active_.empty()) complement_.compute(complement(active_, active_));
}

void DenseBorder::apply(std::span<double> x, std::span<double> m) const {
  const auto count = static_cast<Eigen::Index>(active_.size());
  Eigen::VectorXd multipliers(count);
  for (Eigen::Index i = 0; i < count; ++i) multipliers[i] = -(m[active_[i]] + parallel_dot(rows_[active_[i]], x));
  if (count > 0) multipliers = complement_.solve(multipliers).eval();
  std::ranges::fill(m, 0.0);
  for (Eigen::Index i = 0; i < count; ++i) {
    m[active_[i]] = multipliers[i];
    const std::vector<double>& column = columns_[active_[i]];
    parallel_for(x.size(), [&](std::size_t k) { x[k] += multipliers[i] * column[k]; });
  }
}

}  // namespace plica
