// Algebraic multigrid by smoothed aggregation (Vanek, Mandel and Brezina 1996): a level's nodes are gathered into
// aggregates, each of which moves as a rigid body on the next coarser level, until a factor is cheap. Theory and
// figures: docs/decisions/0007-multigrid.md.
#include <optional>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/algebra/linear_solver.hpp"
#include "solver/multigrid/smoother.hpp"
#include "solver/multigrid/transfer.hpp"

namespace plica {
namespace multigrid {
namespace {

constexpr std::size_t few_unknowns = 6000;  // solved by the factor: that takes less than a product of a large level

template <int B>
struct Level {
  explicit Level(const BlockPattern& pattern, std::span<const int> places = {})
      : matrix(pattern, places),
        smoother(matrix),
        transfer(matrix.rows()),
        galerkin(matrix.rows(), transfer),
        x(matrix.unknowns()),
        r(matrix.unknowns()),
        correction(matrix.unknowns()) {}

  /// Takes values of this level's matrix and leaves those of the coarser one's. The same for the near kernel.
  [[nodiscard]] bool update(UninitialisedVector<float>& coarse_values, std::span<const float> values,
                            UninitialisedVector<float>& near_kernel) {
    if (!matrix.set(values) || !smoother.update()) return false;
    transfer.update(matrix, smoother.largest_eigenvalue(), near_kernel);
    coarse_values = galerkin.values(matrix, transfer);
    return true;
  }

  Matrix<B> matrix;
  Smoother<B> smoother;
  Transfer<B> transfer;
  Galerkin<B> galerkin;
  std::vector<float> x, r, correction;
};

// The last level: blocks of 6 x 6 given to the factor as four of 3 x 3.
class Coarsest {
 public:
  explicit Coarsest(const BlockPattern& pattern) : pattern_(pattern), factor_(halves(pattern)) {}

  [[nodiscard]] bool update(std::span<const float> values) {
    std::vector<float> of_halves;
    for_halves(pattern_, [&](int, int, int place, int i, int j) {
      for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
          of_halves.push_back(values[std::size_t{36} * place + 6 * (3 * i + row) + 3 * j + column]);
    });
    return factor_.factorise(of_halves);
  }
  void solve(std::span<float> x) const { factor_.solve(x); }
  [[nodiscard]] std::size_t unknowns() const { return 6 * static_cast<std::size_t>(pattern_.nodes()); }

 private:
  // Calls take(row, column, block, i, j) for the 3 x 3 blocks on and below the diagonal, by rows.
  template <class Take>
  static void for_halves(const BlockPattern& pattern, const Take& take) {
    for (int node = 0; node < pattern.nodes(); ++node)
      for (int i = 0; i < 2; ++i)
        for (int place = pattern.starts[node]; place < pattern.starts[node + 1]; ++place)
          for (int j = 0; j < 2; ++j)
            if (pattern.columns[place] < node || j <= i)
              take(2 * node + i, 2 * pattern.columns[place] + j, place, i, j);
  }
  static BlockPattern halves(const BlockPattern& pattern) {
    BlockPattern result{std::vector<int>(2 * pattern.starts.size() - 1, 0), {}};
    for_halves(pattern, [&](int row, int column, int, int, int) {
      result.columns.push_back(column);
      result.starts[row + 1] = static_cast<int>(result.columns.size());
    });
    return result;
  }

  BlockPattern pattern_;
  BlockCholesky factor_;
};

class Multigrid final : public Preconditioner {
 public:
  explicit Multigrid(const BlockPattern& pattern)
      : places_(places_by_distance(pattern)), finest_(std::make_unique<Level<3>>(pattern, places_)) {
    const BlockPattern* next = &finest_->galerkin.pattern();
    while (6 * static_cast<std::size_t>(next->nodes()) > few_unknowns) {
      auto level = std::make_unique<Level<6>>(*next);
      if (level->galerkin.pattern().nodes() >= next->nodes()) break;  // no neighbours are left
      coarser_.push_back(std::move(level));
      next = &coarser_.back()->galerkin.pattern();
    }
    if (next->nodes() > 0) coarsest_.emplace(*next);
    coarsest_x_.resize(6 * static_cast<std::size_t>(next->nodes()));
  }

  [[nodiscard]] bool factorise(std::span<const float> values, std::span<const float> near_kernel) override {
    UninitialisedVector<float> motions_of_level(near_kernel.size()), next, finer;
    parallel_for(places_.size(), [&](std::size_t node) {
      std::copy_n(&near_kernel[18 * node], 18, &motions_of_level[18 * std::size_t(places_[node])]);
    });
    if (!finest_->update(next, values, motions_of_level)) return false;
    for (auto& level : coarser_) {
      finer.swap(next);
      if (!level->update(next, finer, motions_of_level)) return false;
    }
    return !coarsest_ || coarsest_->update(next);
  }

  void solve(std::span<float> x) const override {
    for (; !x.empty(); x = x.subspan(finest_->r.size())) {
      parallel_for(places_.size(), [&](std::size_t node) {
        std::copy_n(&x[3 * node], 3, &finest_->r[3 * std::size_t(places_[node])]);
      });
      cycle(*finest_, 0);
      parallel_for(places_.size(), [&](std::size_t node) {
        std::copy_n(&finest_->x[3 * std::size_t(places_[node])], 3, &x[3 * node]);
      });
    }
  }

 private:
  // x = about A^-1 r; uses r up.
  template <int B>
  void cycle(Level<B>& level, std::size_t next) const {
    level.smoother.start(level.r, level.x);
    const bool last = next == coarser_.size();
    level.transfer.restrict_to(level.r, last ? coarsest_x_ : coarser_[next]->r);
    if (!last)
      cycle(*coarser_[next], next + 1);
    else if (coarsest_)
      coarsest_->solve(coarsest_x_);
    level.transfer.prolong(last ? coarsest_x_ : coarser_[next]->x, level.correction);
    level.smoother.finish(level.correction, level.r, level.x);
  }

  std::vector<int> places_;  // of the nodes in the finest level
  std::unique_ptr<Level<3>> finest_;
  std::vector<std::unique_ptr<Level<6>>> coarser_;
  std::optional<Coarsest> coarsest_;
  mutable std::vector<float> coarsest_x_;
};

}  // namespace
}  // namespace multigrid

std::unique_ptr<Preconditioner> make_multigrid(const BlockPattern& pattern) {
  if (3 * static_cast<std::size_t>(pattern.nodes()) <= multigrid::few_unknowns)
    return std::make_unique<BlockCholesky>(pattern);
  return std::make_unique<multigrid::Multigrid>(pattern);
}

}  // namespace plica
