// Cholesky factor of a sparse matrix of 3 x 3 blocks, one per node, in single precision: a preconditioner that is cheap
// to apply many times.
//
// Multifrontal: nodes are ordered by nested dissection (METIS), columns of equal structure form supernodes, and each is
// eliminated in a dense front, to which its children add their updates; subtrees are distributed over threads. A
// factor is applied much more often than computed, so each supernode's panel [L11; L21] is kept as P = [L11^-1; L21
// L11^-1]: both triangular solves are then products with P and its transpose, without inner dependencies, at the cost
// of reading P twice. Large factors are read by several threads: each takes subtrees, whose updates to nodes above are
// stored separately and added in a fixed order. Alternatives: MUMPS (double precision; 2 ms per solve at 4500
// unknowns, 0.2 ms here), CHOLMOD (its supernodal part is GPL), Eigen's SimplicialLLT (no supernodes).
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/linear_solver.hpp"
#include "solver/algebra/panel_products.hpp"
#include "solver/algebra/sparse_pattern.hpp"

namespace plica {

class BlockCholesky final : public Preconditioner {
 public:
  /// Factor size, 8 MB, from which solves are distributed over threads.
  static constexpr std::size_t worth_sharing = 2'000'000;

  /// Find the structure of the factor; once per topology. `kernels` selects the products of solves. `positions`: those
  /// of a factor of a similar pattern (`positions`), to eliminate nodes in its order; empty: find an order.
  explicit BlockCholesky(const BlockPattern& pattern, Kernels kernels = chosen_kernels(),
                         std::vector<int> positions = {});

  /// Factorise; `values` are the blocks of the pattern, nine numbers each, by rows. False if the matrix is not
  /// positive definite in single precision: it is up to condition numbers of 1e6, and rarely beyond 1e7.
  [[nodiscard]] bool factorise(std::span<const float> values);
  [[nodiscard]] bool factorise(std::span<const float> values, std::span<const float> /*near_kernel*/) override {
    return factorise(values);
  }

  /// Solve in place with the last factor: x = b in, x = A^-1 b out, with relative error of about 1e-7 times the
  /// condition number.
  void solve(std::span<float> x) const override;

  struct alignas(16) NodeNumbers {
    float numbers[4];  // the last is padding
  };
  /// Values per node in order of elimination.
  using Halfway = std::vector<NodeNumbers>;

  /// Half solves with A = L L^T: z = L^-1 b, and x = L^-T z, which overwrites z. For sparse b the first is faster, and
  /// z is zero at nodes not reached in the elimination tree.
  void solve_down(std::span<const float> b, Halfway& z) const;
  void solve_up(Halfway& z, std::span<float> x) const;

  /// Number of stored values, including zeros inside panels.
  [[nodiscard]] std::size_t factor_size() const { return factor_size_; }
  /// Return the position of each node in order of elimination.
  [[nodiscard]] const std::vector<int>& positions() const { return position_; }

 private:
  struct Block {
    std::size_t number;  // in the pattern
    int row, column;     // in the front
    bool turned;         // transposed in the front
  };
  struct Run {
    int first, last,
        in_parent;  // rows `first` to `last` - 1 are also consecutive in the front of the parent, from here
  };
  struct Supernode {
    int first = 0, columns = 0;  // nodes in elimination order
    std::vector<int> rows;       // nodes below, ascending
    std::vector<Run> runs;       // their positions in the front of the parent
    std::size_t panel = 0;       // start of its panel
    std::vector<int> children;   // supernodes that update this one
    std::vector<Block> blocks;   // matrix blocks assembled here
    int subtree = 0;             // first supernode of its subtree, which is contiguous
    double work = 0;             // cost of eliminating its subtree, approximate multiply-adds

    // Sizes of its panel, in numbers.
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

  // Supernodes of one thread in a solve, children first.
  struct Part {
    std::vector<int> supernodes;
    int end = 0;                    // first node above it in order of elimination
    Halfway above;                  // its contribution to nodes above
    std::vector<float> own;         // scratch: values of a supernode,
    std::vector<PanelChunk> front;  // and input or output of its panel product
  };
  void share_out();
  template <class Body>
  void for_branches(const Body& body) const;
  void solve_down(const Supernode& node, Part& part, Halfway& x) const;  // from children to parents
  void solve_up(const Supernode& node, Part& part, Halfway& x) const;

  const PanelProducts* products_;
  int nodes_ = 0;
  std::vector<int> position_;          // position of each node in order of elimination
  std::vector<Supernode> supernodes_;  // children before parents
  UninitialisedVector<PanelChunk> panels_;
  std::size_t factor_size_ = 0;
  mutable std::vector<Part> branches_;  // independent subtrees; empty in a small factor
  mutable Part trunk_;                  // all others
  mutable Halfway z_;                   // scratch of solve()
};

}  // namespace plica
