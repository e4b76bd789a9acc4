// Cholesky factor of a sparse matrix of 3 x 3 blocks, one a node, kept in single precision: a preconditioner that is
// cheap to apply many times.
//
// Multifrontal: nodes are ordered by nested dissection (METIS), columns of like structure form supernodes, and each is
// eliminated in a dense front, to which its children add their updates; subtrees are shared out among the threads. A
// factor is applied much more often than it is made, so each supernode's panel [L11; L21] is kept as P = [L11^-1; L21
// L11^-1]: both triangular solves are then plain products with P and its transpose, without dependencies inside, and
// their time is that of reading P twice. Large factors are read by several threads: each takes subtrees, whose updates
// of what is above them are kept apart and added in a fixed order. Weighed: MUMPS (double precision; 2 ms a solve at
// 4500 unknowns, against 0.2 ms here), CHOLMOD (its supernodal part is GPL), Eigen's SimplicialLLT (no supernodes).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/block_pattern.hpp"
#include "solver/algebra/panel_products.hpp"
#include "solver/algebra/preconditioner.hpp"

namespace plica {

class BlockCholesky final : public Preconditioner {
 public:
  /// Numbers in a factor, 8 MB, from which on threads share out a solve, which reads them twice.
  static constexpr std::size_t worth_sharing = 2'000'000;

  /// Orders the nodes and finds where the factor has entries. Once a topology. `kernels`: of the solves' products.
  explicit BlockCholesky(const BlockPattern& pattern, Kernels kernels = chosen_kernels());

  /// Factorises; `values` are the pattern's blocks, nine numbers each, by rows. False when the matrix is not positive
  /// definite in single precision: for condition numbers up to 1e6 it is, beyond 1e7 it hardly can be.
  [[nodiscard]] bool factorise(std::span<const float> values);
  [[nodiscard]] bool factorise(std::span<const float> values, std::span<const float> /*near_kernel*/) override {
    return factorise(values);
  }

  /// Solves in place with the last factor: x = b in, x = A^-1 b out, to about 1e-7 times the condition number.
  void solve(std::span<float> x) const override;

  struct alignas(16) NodeNumbers {
    float numbers[4];  // the last does not matter
  };
  /// The numbers of each node in the order of elimination.
  using Halfway = std::vector<NodeNumbers>;

  /// The halves of a solve with A = L L^T: z = L^-1 b, and x = L^-T z, which uses z up. Where b is zero in most nodes
  /// the first takes a part of the time, and z is zero where no path in the tree of elimination leads from b's others.
  void solve_down(std::span<const float> b, Halfway& z) const;
  void solve_up(Halfway& z, std::span<float> x) const;

  /// Numbers kept in the factor, zeros inside panels included.
  [[nodiscard]] std::size_t factor_size() const { return factor_size_; }

 private:
  struct Block {
    std::size_t number;  // in the pattern
    int row, column;     // in the front
    bool turned;         // transposed there
  };
  struct Run {
    int first, last, in_parent;  // rows `first` to before `last` follow each other in the parent's front too, from here
  };
  struct Supernode {
    int first = 0, columns = 0;  // nodes in elimination order
    std::vector<int> rows;       // nodes below, ascending
    std::vector<Run> runs;       // where they are in the parent's front
    std::size_t panel = 0;       // where its panel begins
    std::vector<int> children;   // supernodes that update this one
    std::vector<Block> blocks;   // of the matrix that are assembled here
    int subtree = 0;             // the first supernode of those from which paths lead here; all are between
    double work = 0;             // to eliminate these and it, multiply-adds or so

    // Of its panel, in numbers.
    [[nodiscard]] std::size_t width() const { return 3 * static_cast<std::size_t>(columns); }
    [[nodiscard]] std::size_t height() const { return 3 * (static_cast<std::size_t>(columns) + rows.size()); }
    [[nodiscard]] std::size_t stride() const { return PanelChunk::size * chunks_for(height()); }  // between columns
  };
  void order(const BlockPattern& pattern);
  void find_supernodes(const std::vector<std::vector<int>>& upper_neighbours);
  void place_blocks(const BlockPattern& pattern);
  static void assemble(const Supernode& node, std::span<const float> values, float* panel);
  static void add_child(const Supernode& child, const float* update, const Supernode& node, float* panel, float* front);
  [[nodiscard]] Panel panel_of(const Supernode& node) const {
    return {&panels_[node.panel], chunks_for(node.height()), 3 * node.columns};
  }
  static bool eliminate(const Supernode& node, float* panel, float* front);
  struct Fronts;
  void factorise_subtree(int root, std::span<const float> values, Fronts& fronts);
  void factorise_front(int s, std::span<const float> values, Fronts& fronts);

  // Supernodes that one thread takes in a solve, children first.
  struct Part {
    std::vector<int> supernodes;
    int end = 0;                    // the first node above it, in the order of elimination
    Halfway above;                  // what it adds to the nodes above it
    std::vector<float> own;         // scratch: a supernode's own numbers,
    std::vector<PanelChunk> front;  // and what its panel is multiplied with, or gives
  };
  void share_out();
  template <class Body>
  void for_branches(const Body& body) const;
  void solve_down(const Supernode& node, Part& part, Halfway& x) const;  // from children to parents
  void solve_up(const Supernode& node, Part& part, Halfway& x) const;

  const PanelProducts* products_;
  int nodes_ = 0;
  std::vector<int> position_;          // of each node in the order of elimination
  std::vector<Supernode> supernodes_;  // children before parents
  UninitialisedVector<PanelChunk> panels_;
  std::size_t factor_size_ = 0;
  mutable std::vector<Part> branches_;  // subtrees that do not depend on each other; none in a small factor
  mutable Part trunk_;                  // all others
  mutable Halfway z_;                   // scratch of solve()
};

}  // namespace plica
