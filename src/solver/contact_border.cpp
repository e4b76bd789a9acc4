#include "solver/contact_border.hpp"

#include <algorithm>

namespace plica {
namespace {

double inner(const std::vector<std::pair<std::size_t, Vec3>>& sparse, std::span<const Vec3> full) {
  double sum = 0;
  for (const auto& [node, value] : sparse) sum += value.dot(full[node]);
  return sum;
}

}  // namespace

void ContactBorder::begin(const Model& model, const StepMatrix& matrix, std::vector<NodeFrame> frames,
                          std::vector<char> in_contact, std::size_t most_changes) {
  model_ = &model;
  matrix_ = &matrix;
  frames_ = std::move(frames);
  in_contact_ = std::move(in_contact);
  most_changes_ = most_changes;
  columns_.clear();
  active_.clear();
}

void ContactBorder::solve_inner(const Preconditioner& factor, std::span<Vec3> x) const {
  single_.resize(3 * x.size());
  for (std::size_t n = 0; n < x.size(); ++n) {
    const Vec3 free = frames_[n].free_part(x[n]);
    for (int i = 0; i < 3; ++i) single_[3 * n + i] = static_cast<float>(free[i]);
  }
  factor.solve(single_);
  for (std::size_t n = 0; n < x.size(); ++n)
    for (int i = 0; i < 3; ++i) x[n][i] = single_[3 * n + i];
}

ContactBorder::Column ContactBorder::make_column(const Iterate& at, std::size_t contact,
                                                 const Preconditioner& factor) const {
  Column column{contact, model_->vitelline->nodes()[contact].index(), {}, !at.in_contact[contact], {}, 0, {}};
  const std::size_t node = column.node;
  Vectors b(frames_.size(), Vec3::Zero());
  if (column.leaves) {
    column.normal = frames_[node].axes.col(frames_[node].fixed - 1);
    Vectors unit(b);
    unit[node] = column.normal;
    matrix_->multiply(unit, b);
    column.diagonal = column.normal.dot(b[node]);
    for (std::size_t n = 0; n < b.size(); ++n) {
      b[n] = frames_[n].free_part(b[n]);
      if (b[n] != Vec3::Zero()) column.entries.emplace_back(n, b[n]);
    }
  } else {
    column.normal = without_held(*model_, node, model_->vitelline->gap(at.positions[node]).inward).normalized();
    b[node] = column.normal;
    column.entries.emplace_back(node, column.normal);
  }
  column.solved = std::move(b);
  solve_inner(factor, column.solved);
  return column;
}

bool ContactBorder::follow(const Iterate& at, const Preconditioner& factor) {
  std::vector<std::size_t> changed, active;
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k] != in_contact_[k]) changed.push_back(k);
  const auto is_new = [&](std::size_t k) { return std::ranges::find(columns_, k, &Column::contact) == columns_.end(); };
  if (changed.size() > most_changes_ || columns_.size() + std::ranges::count_if(changed, is_new) > most_changes_)
    return false;
  for (const std::size_t k : changed) {
    const auto known = std::ranges::find(columns_, k, &Column::contact);
    if (known == columns_.end()) {
      columns_.push_back(make_column(at, k, factor));
      active.push_back(columns_.size() - 1);
    } else {
      active.push_back(static_cast<std::size_t>(known - columns_.begin()));
    }
  }
  if (active == active_) return true;
  active_ = std::move(active);
  const auto size = static_cast<Eigen::Index>(active_.size());
  Eigen::MatrixXd schur(size, size);
  for (Eigen::Index i = 0; i < size; ++i)
    for (Eigen::Index j = 0; j < size; ++j) {
      const Column &a = columns_[active_[i]], &b = columns_[active_[j]];
      schur(i, j) = (i == j ? a.diagonal : 0) - inner(a.entries, b.solved);
      // D between two nodes that have left; that of neighbours is in the matrix.
      if (i != j && a.leaves && b.leaves) schur(i, j) += a.normal.dot(matrix_->block(a.node, b.node) * b.normal);
    }
  if (size > 0) schur_.compute(schur);
  return true;
}

void ContactBorder::solve(const Preconditioner& factor, std::span<Vec3> x) const {
  const auto size = static_cast<Eigen::Index>(active_.size());
  Eigen::VectorXd border(size);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Column& column = columns_[active_[i]];
    border[i] = column.leaves ? column.normal.dot(x[column.node]) : 0;
  }
  solve_inner(factor, x);
  if (size == 0) return;
  for (Eigen::Index i = 0; i < size; ++i) border[i] -= inner(columns_[active_[i]].entries, x);
  border = schur_.solve(border).eval();
  for (Eigen::Index i = 0; i < size; ++i) {
    const Column& column = columns_[active_[i]];
    for (std::size_t n = 0; n < x.size(); ++n) x[n] -= border[i] * column.solved[n];
    if (column.leaves) x[column.node] += border[i] * column.normal;
  }
}

}  // namespace plica
