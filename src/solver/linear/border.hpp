// Borders around systems that are solved without them: of changed contacts, and of dense rows.
#pragma once

#include <Eigen/LU>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/node_frame.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

/// Update a factor for nodes that have since left or reached obstacles. The factor has the directions fixed when it was
/// computed; each changed node borders it with one more unknown (its free normal) or condition (its fixed normal):
///   [ A0   B ] [ x  ]   [ f        ]     B: columns A n of nodes that left, n of nodes that arrived,
///   [ B^T  D ] [ xi ] = [ n^T f, 0 ]     D: n^T A n among those that left.
/// With A0 = L L^T and Y = L^-1 B this is, between the two halves of a solve with the factor,
///   z = L^-1 f,   (D - Y^T Y) xi = [ n^T f, 0 ] - Y^T z,   x = L^-T (z - Y xi).
/// Y is sparse: a column costs a fraction of half a solve, once.
class ContactBorder {
 public:
  /// Start with a new factor of `matrix` (which must not change until the next call) with these frames and contacts.
  void begin(const Model& model, const Contacts& contacts, const StepMatrix& matrix, std::vector<NodeFrame> frames,
             std::vector<char> in_contact, std::size_t most_changes);

  /// Add changes of contacts since. False if there are too many, or one of a node in several contacts: compute a new
  /// factor then.
  [[nodiscard]] bool follow(const Iterate& at, const BlockCholesky& factor);

  /// Apply factor and border in place; free nodes.
  void solve(const BlockCholesky& factor, std::span<Vec3> x) const;

 private:
  struct Change {
    std::size_t contact;
    bool leaves;
    Vec3 normal;
  };
  struct Column : Change {
    std::size_t node;
    std::vector<std::pair<int, Vec3>> halfway;  // entries of Y: position in order of elimination, values
  };
  [[nodiscard]] bool is_alone(std::size_t contact, const Iterate& at) const;
  void add_column(const Change& change, const BlockCholesky& factor);
  void write_free(std::span<const Vec3> vectors) const;  // to single_

  const Model* model_ = nullptr;
  const Contacts* contacts_ = nullptr;
  const StepMatrix* matrix_ = nullptr;
  std::vector<NodeFrame> frames_;
  std::vector<char> in_contact_;
  std::size_t most_changes_ = 0;
  std::vector<Column> columns_;      // all changes since; some may be undone
  Eigen::MatrixXd complement_;       // D - Y^T Y of all columns
  std::vector<std::size_t> active_;  // columns in use
  Eigen::PartialPivLU<Eigen::MatrixXd> active_complement_;
  mutable std::vector<float> single_;  // scratch
  mutable BlockCholesky::Halfway z_;
};

/// Border of dense rows around a system solved without them: functions of thousands of nodes (enclosed volume), whose
/// outer products would fill any matrix. Each costs one solve per direction.
///   [ K  -B^T ] [ x ]   [ f ]
///   [ -B   0  ] [ m ] = [ g ]     x = K^-1 f + Y m,  S m = -(g + B K^-1 f),  Y = K^-1 B^T,  S = B Y.
class DenseBorder {
 public:
  /// Compute the border. `solve` applies the inverse of K, or an approximation, in place. `rows`: those of B, with the
  /// length of its argument.
  void begin(std::vector<std::vector<double>> rows, const std::function<void(std::span<double>)>& solve);

  [[nodiscard]] bool empty() const { return rows_.empty(); }

  /// Convert K^-1 f and g to x and m, in place.
  void apply(std::span<double> x, std::span<double> m) const;

 private:
  std::vector<std::vector<double>> rows_, columns_;  // B, Y
  std::vector<Eigen::Index> active_;                 // rows with a multiplier
  Eigen::PartialPivLU<Eigen::MatrixXd> complement_;  // S of active rows
};

}  // namespace plica
