// Borders around systems that are solved without them: of changed contacts, and of dense rows.
#pragma once

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/node_frame.hpp"
#include "solver/linear/system_matrix.hpp"

namespace plica {

/// Update a factor for nodes that have since left or reached obstacles. The factor has the directions fixed when it was
/// computed; each changed node borders it with one more unknown (its free normal) or condition (its fixed normal):
///   [ A0   B ] [ x  ]   [ f        ]     B: columns A n of nodes that left, n of nodes that arrived,
///   [ B^T  D ] [ xi ] = [ n^T f, 0 ]     D: n^T A n among those that left.
/// With A0 = L L^T and Y = L^-1 B this is, between the two halves of a solve with the factor,
///   z = L^-1 f,   (D - Y^T Y) xi = [ n^T f, 0 ] - Y^T z,   x = L^-T (z - Y xi).
/// Y is sparse: a column costs a fraction of half a solve, once.
class ObstacleBorder {
 public:
  /// Start with a new factor of `matrix` (which must not change until the next call) with these frames and contacts.
  void begin(const Model& model, const ObstacleContacts& contacts, const SystemMatrix& matrix,
             std::vector<NodeFrame> frames, std::vector<char> on_obstacle, std::size_t most_changes) {
    model_ = &model;
    contacts_ = &contacts;
    matrix_ = &matrix;
    frames_ = std::move(frames);
    on_obstacle_ = std::move(on_obstacle);
    most_changes_ = most_changes;
    columns_.clear();
    active_.clear();
  }

  /// Add changes of contacts since. False if there are too many, or one of a node in several contacts: compute a new
  /// factor then.
  [[nodiscard]] bool follow(const Iterate& at, const BlockCholesky& factor) {
    std::vector<std::size_t> changed, active;
    std::vector<Change> unknown;
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k)
      if (at.on_obstacle[k] != on_obstacle_[k]) changed.push_back(k);
    const auto column_of = [&](std::size_t k) { return std::ranges::find(columns_, k, &Column::contact); };
    for (const std::size_t k : changed) {
      if (column_of(k) != columns_.end()) continue;
      if (!is_alone(k, at)) return false;
      const std::size_t n = contacts_->node(k).index();
      const bool leaves = !at.on_obstacle[k];
      unknown.push_back({k, leaves,
                         leaves ? Vec3(frames_[n].axes.col(frames_[n].fixed - 1))
                                : without_held(*model_, n, contacts_->gap(k, at.positions).inward).normalized()});
    }
    if (changed.size() > most_changes_ || columns_.size() + unknown.size() > most_changes_) return false;
    for (const Change& change : unknown) add_column(change, factor);
    for (const std::size_t k : changed) active.push_back(static_cast<std::size_t>(column_of(k) - columns_.begin()));
    if (active == active_) return true;
    active_ = std::move(active);
    if (!active_.empty()) active_complement_.compute(complement_(active_, active_));
    return true;
  }

  /// Apply factor and border in place; free nodes.
  void solve(const BlockCholesky& factor, std::span<Vec3> x) const {
    const auto size = static_cast<Eigen::Index>(active_.size());
    Eigen::VectorXd border(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Column& column = columns_[active_[i]];
      border[i] = column.leaves ? column.normal.dot(x[column.node]) : 0;
    }
    write_free(x);
    factor.solve_down(single_, z_);
    if (size > 0) {
      for (Eigen::Index i = 0; i < size; ++i) border[i] -= inner(columns_[active_[i]].halfway, z_);
      border = active_complement_.solve(border).eval();
      for (Eigen::Index i = 0; i < size; ++i) subtract(border[i], columns_[active_[i]].halfway, z_);
    }
    factor.solve_up(z_, single_);
    for (std::size_t n = 0; n < x.size(); ++n) x[n] = Eigen::Map<const Eigen::Vector3f>(&single_[3 * n]).cast<double>();
    for (Eigen::Index i = 0; i < size; ++i)
      if (const Column& column = columns_[active_[i]]; column.leaves) x[column.node] += border[i] * column.normal;
  }

 private:
  using Halfway = BlockCholesky::Halfway;
  static double inner(const std::vector<std::pair<int, Vec3>>& sparse, const Halfway& full) {
    double sum = 0;
    for (const auto& [place, value] : sparse) {
      const float* numbers = full[place].numbers;
      sum += value[0] * numbers[0] + value[1] * numbers[1] + value[2] * numbers[2];
    }
    return sum;
  }

  static void subtract(double factor, const std::vector<std::pair<int, Vec3>>& sparse, Halfway& from) {
    for (const auto& [place, value] : sparse)
      for (int i = 0; i < 3; ++i) from[place].numbers[i] -= static_cast<float>(factor * value[i]);
  }

  struct Change {
    std::size_t contact;
    bool leaves;
    Vec3 normal;
  };
  struct Column : Change {
    std::size_t node;
    std::vector<std::pair<int, Vec3>> halfway;  // entries of Y: position in order of elimination, values
  };
  // Whether its node touches nothing else, now or in the factor.
  [[nodiscard]] bool is_alone(std::size_t contact, const Iterate& at) const {
    return std::ranges::all_of(contacts_->beside(contact), [&](std::size_t other) {
      return other == contact || (!at.on_obstacle[other] && !on_obstacle_[other]);
    });
  }
  void add_column(const Change& change, const BlockCholesky& factor) {
    Column column{change, contacts_->node(change.contact).index(), {}};
    Vectors b(frames_.size());
    double diagonal = 0;
    if (column.leaves) {
      matrix_->multiply(column.node, column.normal, b);
      diagonal = column.normal.dot(b[column.node]);
      write_free(b);
    } else {
      single_.assign(3 * b.size(), 0.0F);
      for (int i = 0; i < 3; ++i) single_[3 * column.node + i] = static_cast<float>(column.normal[i]);
    }
    factor.solve_down(single_, z_);
    for (std::size_t place = 0; place < z_.size(); ++place)
      if (const Vec3 value = Eigen::Map<const Eigen::Vector3f>(z_[place].numbers).cast<double>(); value != Vec3::Zero())
        column.halfway.emplace_back(static_cast<int>(place), value);

    columns_.push_back(std::move(column));
    const Column& last = columns_.back();
    const auto i = static_cast<Eigen::Index>(columns_.size()) - 1;
    complement_.conservativeResize(i + 1, i + 1);
    complement_(i, i) = diagonal - inner(last.halfway, z_);
    for (Eigen::Index j = 0; j < i; ++j) {
      const Column& other = columns_[j];
      // D between two nodes that have left; that of neighbours is in the matrix.
      const double between =
          last.leaves && other.leaves ? last.normal.dot(matrix_->block(last.node, other.node) * other.normal) : 0;
      complement_(i, j) = complement_(j, i) = between - inner(other.halfway, z_);
    }
  }
  void write_free(std::span<const Vec3> vectors) const {
    single_.resize(3 * vectors.size());
    for (std::size_t n = 0; n < vectors.size(); ++n) {
      const Vec3 free = frames_[n].free_part(vectors[n]);
      for (int i = 0; i < 3; ++i) single_[3 * n + i] = static_cast<float>(free[i]);
    }
  }  // to single_

  const Model* model_ = nullptr;
  const ObstacleContacts* contacts_ = nullptr;
  const SystemMatrix* matrix_ = nullptr;
  std::vector<NodeFrame> frames_;
  std::vector<char> on_obstacle_;
  std::size_t most_changes_ = 0;
  std::vector<Column> columns_;      // all changes since; some may be undone
  Eigen::MatrixXd complement_;       // D - Y^T Y of all columns
  std::vector<std::size_t> active_;  // columns in use
  Eigen::PartialPivLU<Eigen::MatrixXd> active_complement_;
  mutable std::vector<float> single_;  // scratch
  mutable Halfway z_;
};

/// Border of dense rows around a system solved without them: functions of thousands of nodes (enclosed volume), whose
/// outer products would fill any matrix. Each costs one solve per direction.
///   [ K  -B^T ] [ x ]   [ f ]
///   [ -B   0  ] [ m ] = [ g ]     x = K^-1 f + Y m,  S m = -(g + B K^-1 f),  Y = K^-1 B^T,  S = B Y.
class DenseBorder {
 public:
  /// Compute the border. `solve` applies the inverse of K, or an approximation, in place. `rows`: those of B, with the
  /// length of its argument.
  void begin(std::vector<std::vector<double>> rows, const std::function<void(std::span<double>)>& solve) {
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

  [[nodiscard]] bool empty() const { return rows_.empty(); }

  /// Convert K^-1 f and g to x and m, in place.
  void apply(std::span<double> x, std::span<double> m) const {
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

 private:
  std::vector<std::vector<double>> rows_, columns_;  // B, Y
  std::vector<Eigen::Index> active_;                 // rows with a multiplier
  Eigen::PartialPivLU<Eigen::MatrixXd> complement_;  // S of active rows
};

}  // namespace plica
