// Lets a factor serve while nodes leave the shell or come to it. The factor has the directions that were fixed when it
// was made; each node that has changed since borders it with one more unknown (its free normal) or condition (its fixed
// one), which costs a solve once:
//   [ A0   B ] [ x  ]   [ f        ]     B: columns A n of nodes that have left, n of nodes that have come,
//   [ B^T  D ] [ xi ] = [ n^T f, 0 ]     D: n^T A n among those that have left.
#pragma once

#include <Eigen/LU>
#include <optional>

#include "solver/preconditioner.hpp"
#include "solver/step_matrix.hpp"

namespace plica {

class ContactBorder {
 public:
  /// The factor is new: of `matrix` (which stays as it is until the next call) with these frames and contacts.
  void begin(const Model& model, const StepMatrix& matrix, std::vector<NodeFrame> frames, std::vector<char> in_contact,
             std::size_t most_changes);

  /// Takes up the changes of contacts since. False when there are too many: the factor should be made anew.
  [[nodiscard]] bool follow(const Iterate& at, const Preconditioner& factor);

  /// Adds the changes that have been taken up to a factor's memory; takes up those of one after `begin`.
  void remember(FactorMemory& memory) const;
  void recall(const FactorMemory& memory, const Preconditioner& factor);

  /// Applies factor and border in place; free nodes.
  void solve(const Preconditioner& factor, std::span<Vec3> x) const;

 private:
  struct Change {
    std::size_t contact;
    bool leaves;
    Vec3 normal;
  };
  struct Column : Change {
    std::size_t node;
    std::vector<std::pair<std::size_t, Vec3>> entries;  // of B: node, value
    double diagonal = 0;                                // of D
    std::vector<float> solved;                          // A0^-1 B
  };
  // Its right side B beside it.
  [[nodiscard]] Column make_column(const Change& change, Vectors& b) const;
  void add_columns(std::span<const Change> changes, const Preconditioner& factor);
  void append_free(std::span<const Vec3> vectors, std::vector<float>& to) const;

  const Model* model_ = nullptr;
  const StepMatrix* matrix_ = nullptr;
  std::vector<NodeFrame> frames_;
  std::vector<char> in_contact_;
  std::size_t most_changes_ = 0;
  std::vector<Column> columns_;      // of all changes since; some may have been undone
  std::vector<std::size_t> active_;  // columns that hold now
  Eigen::PartialPivLU<Eigen::MatrixXd> schur_;
  mutable std::vector<float> single_;
};

}  // namespace plica
