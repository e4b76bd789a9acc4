#include "solver/contact_border.hpp"

#include <algorithm>

namespace plica {
namespace {

Vec3 at_node(std::span<const float> full, std::size_t node) {
  return {full[3 * node], full[3 * node + 1], full[3 * node + 2]};
}

double inner(const std::vector<std::pair<std::size_t, Vec3>>& sparse, std::span<const float> full) {
  double sum = 0;
  for (const auto& [node, value] : sparse) sum += value.dot(at_node(full, node));
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

void ContactBorder::append_free(std::span<const Vec3> vectors, std::vector<float>& to) const {
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    const Vec3 free = frames_[n].free_part(vectors[n]);
    for (int i = 0; i < 3; ++i) to.push_back(static_cast<float>(free[i]));
  }
}

ContactBorder::Column ContactBorder::make_column(const Change& change, Vectors& b) const {
  Column column{change, model_->vitelline->nodes()[change.contact].index(), {}, 0, {}};
  b.assign(frames_.size(), Vec3::Zero());
  if (column.leaves) {
    Vectors unit(b);
    unit[column.node] = column.normal;
    matrix_->multiply(unit, b);
    column.diagonal = column.normal.dot(b[column.node]);
    for (std::size_t n = 0; n < b.size(); ++n) {
      b[n] = frames_[n].free_part(b[n]);
      if (b[n] != Vec3::Zero()) column.entries.emplace_back(n, b[n]);
    }
  } else {
    b[column.node] = column.normal;
    column.entries.emplace_back(column.node, column.normal);
  }
  return column;
}

void ContactBorder::add_columns(std::span<const Change> changes, const Preconditioner& factor) {
  if (changes.empty()) return;
  std::vector<float> solved;
  Vectors b;
  for (const Change& change : changes) {
    columns_.push_back(make_column(change, b));
    append_free(b, solved);
  }
  factor.solve(solved);
  const std::size_t size = 3 * frames_.size();
  for (std::size_t i = 0; i < changes.size(); ++i)
    columns_[columns_.size() - changes.size() + i].solved.assign(&solved[i * size], &solved[i * size] + size);
}

void ContactBorder::remember(FactorMemory& memory) const {
  for (const Column& column : columns_) {
    memory.changed_contacts.push_back(static_cast<int>(column.contact));
    memory.has_left.push_back(column.leaves);
    memory.normals.push_back(column.normal);
  }
}

void ContactBorder::recall(const FactorMemory& memory, const Preconditioner& factor) {
  std::vector<Change> changes;
  for (std::size_t k = 0; k < memory.changed_contacts.size(); ++k)
    changes.push_back(
        {static_cast<std::size_t>(memory.changed_contacts[k]), memory.has_left[k] != 0, memory.normals[k]});
  add_columns(changes, factor);
}

bool ContactBorder::follow(const Iterate& at, const Preconditioner& factor) {
  std::vector<std::size_t> changed, active;
  std::vector<Change> unknown;
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k] != in_contact_[k]) changed.push_back(k);
  const auto column_of = [&](std::size_t k) { return std::ranges::find(columns_, k, &Column::contact); };
  for (const std::size_t k : changed) {
    if (column_of(k) != columns_.end()) continue;
    const std::size_t n = model_->vitelline->nodes()[k].index();
    const bool leaves = !at.in_contact[k];
    unknown.push_back({k, leaves,
                       leaves ? Vec3(frames_[n].axes.col(frames_[n].fixed - 1))
                              : without_held(*model_, n, model_->vitelline->gap(at.positions[n]).inward).normalized()});
  }
  if (changed.size() > most_changes_ || columns_.size() + unknown.size() > most_changes_) return false;
  add_columns(unknown, factor);
  for (const std::size_t k : changed) active.push_back(static_cast<std::size_t>(column_of(k) - columns_.begin()));
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
  single_.clear();
  append_free(x, single_);
  factor.solve(single_);
  if (size > 0) {
    for (Eigen::Index i = 0; i < size; ++i) border[i] -= inner(columns_[active_[i]].entries, single_);
    border = schur_.solve(border).eval();
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto part = static_cast<float>(border[i]);
      const std::vector<float>& solved = columns_[active_[i]].solved;
      for (std::size_t k = 0; k < single_.size(); ++k) single_[k] -= part * solved[k];
    }
  }
  for (std::size_t n = 0; n < x.size(); ++n) x[n] = at_node(single_, n);
  for (Eigen::Index i = 0; i < size; ++i)
    if (const Column& column = columns_[active_[i]]; column.leaves) x[column.node] += border[i] * column.normal;
}

}  // namespace plica
