#include "solver/algebra/block_cholesky.hpp"

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <utility>

#include "solver/algebra/blas.hpp"

extern "C" {  // BLAS
void strsm_(const char* side, const char* triangle, const char* transposed, const char* diagonal, const int* m,
            const int* n, const float* alpha, const float* a, const int* lda, float* b, const int* ldb);
void strmm_(const char* side, const char* triangle, const char* transposed, const char* diagonal, const int* m,
            const int* n, const float* alpha, const float* a, const int* lda, float* b, const int* ldb);
void ssyrk_(const char* triangle, const char* transposed, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* beta, float* c, const int* ldc);
}

namespace plica {
namespace {

using Neighbours = std::vector<std::vector<int>>;

// Elimination tree of a matrix whose column j has entries in rows `below[j]` (Liu 1990): parent of each column or -1.
std::vector<int> elimination_tree(const Neighbours& below) {
  const int n = static_cast<int>(below.size());
  Neighbours before(n);
  for (int j = 0; j < n; ++j)
    for (const int i : below[j]) before[i].push_back(j);
  std::vector<int> parent(n, -1), ancestor(n, -1);
  for (int i = 0; i < n; ++i)
    for (int j : before[i])
      while (j != -1 && j < i) {  // climb to the root, shortening the path on the way
        const int next = ancestor[j];
        ancestor[j] = i;
        if (next == -1) parent[j] = i;
        j = next;
      }
  return parent;
}

std::vector<int> postorder(const std::vector<int>& parent) {
  const int n = static_cast<int>(parent.size());
  Neighbours children(n);
  std::vector<int> stack, order;
  for (int j = n; j-- > 0;) {
    if (parent[j] == -1)
      stack.push_back(j);
    else
      children[parent[j]].push_back(j);
  }
  while (!stack.empty()) {  // parents first, then turned round
    const int j = stack.back();
    stack.pop_back();
    order.push_back(j);
    for (const int child : children[j]) stack.push_back(child);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

}  // namespace

BlockCholesky::BlockCholesky(const BlockPattern& pattern, Kernels kernels, std::vector<int> positions)
    : products_(&panel_products(kernels)), nodes_(pattern.nodes()), position_(std::move(positions)) {
  prepare_blas();
  if (position_.empty()) position_ = elimination_order(pattern);
  order(pattern);
  place_blocks(pattern);
  std::size_t size = 0;
  for (auto& node : supernodes_) {
    node.panel = size;
    size += node.width() * chunks_for(node.height());
    factor_size_ += node.width() * node.height();
    node.subtree = static_cast<int>(&node - supernodes_.data());
    if (!node.children.empty()) node.subtree = supernodes_[node.children.front()].subtree;
    node.work = static_cast<double>(node.width()) * static_cast<double>(node.height() * node.height());
    for (const int child : node.children) node.work += supernodes_[child].work;
  }
  panels_.resize(size);
  share_out();
}

// Independent of the number of threads: other branches would add in another order.
void BlockCholesky::share_out() {
  std::vector<std::size_t> size(supernodes_.size());  // of each subtree
  std::vector<int> roots;
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const Supernode& node = supernodes_[s];
    size[s] = node.width() * node.height();
    for (const int child : node.children) size[s] += size[child];
    if (node.rows.empty() && factor_size_ >= worth_sharing) roots.push_back(static_cast<int>(s));
  }
  // The trunk contains the parts that are too large, or too small, for a thread of their own.
  const std::size_t largest = factor_size_ / 12, least = factor_size_ / 200;
  std::vector<char> is_trunk(supernodes_.size(), 1);
  while (!roots.empty()) {
    const int root = roots.back();
    roots.pop_back();
    const Supernode& node = supernodes_[root];
    if (size[root] > largest) {
      roots.insert(roots.end(), node.children.begin(), node.children.end());
    } else if (size[root] > least) {
      Part& branch = branches_.emplace_back();
      for (int s = node.subtree; s <= root; ++s) {
        branch.supernodes.push_back(s);
        is_trunk[s] = 0;
      }
      branch.end = node.first + node.columns;
      branch.above.resize(nodes_);
    }
  }
  for (std::size_t s = 0; s < supernodes_.size(); ++s)
    if (is_trunk[s]) trunk_.supernodes.push_back(static_cast<int>(s));
  trunk_.end = nodes_;
  const auto make_scratch = [&](Part& part) {
    std::size_t widest = 0, longest = 0;
    for (const int s : part.supernodes) {
      widest = std::max(widest, supernodes_[s].width());
      longest = std::max(longest, supernodes_[s].height());
    }
    part.own.resize(widest + 1);  // as vectors of four
    part.front.resize(chunks_for(longest + 1));
  };
  std::ranges::for_each(branches_, make_scratch);
  make_scratch(trunk_);
}

void BlockCholesky::order(const BlockPattern& pattern) {
  const auto below_in_order = [&] {
    Neighbours below(nodes_);
    for (int row = 0; row < nodes_; ++row)
      for (int at = pattern.starts[row]; at < pattern.starts[row + 1] - 1; ++at) {
        const int i = position_[row], j = position_[pattern.columns[at]];
        below[std::min(i, j)].push_back(std::max(i, j));
      }
    return below;
  };
  // Children just before their parents, so that supernodes are runs of columns.
  const std::vector<int> order = postorder(elimination_tree(below_in_order()));
  std::vector<int> place(nodes_);
  for (int i = 0; i < nodes_; ++i) place[order[i]] = i;
  for (int& position : position_) position = place[position];
  find_supernodes(below_in_order());
}

void BlockCholesky::find_supernodes(const Neighbours& below) {
  const std::vector<int> parent = elimination_tree(below);
  Neighbours children(nodes_);
  for (int j = 0; j < nodes_; ++j)
    if (parent[j] != -1) children[parent[j]].push_back(j);
  const auto size = [](double columns, double rows) { return columns * (columns + rows); };

  std::vector<std::vector<int>> rows_of(nodes_);  // structure of each column below its diagonal, until merged
  std::vector<double> zeros;                      // of each supernode, in blocks
  for (int j = 0; j < nodes_; ++j) {
    auto& rows = rows_of[j];
    rows = below[j];
    for (const int child : children[j]) rows.insert(rows.end(), rows_of[child].begin(), rows_of[child].end());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    rows.erase(rows.begin(), std::upper_bound(rows.begin(), rows.end(), j));
    for (const int child : children[j]) std::vector<int>().swap(rows_of[child]);

    supernodes_.push_back(
        {.first = j, .columns = 1, .rows = rows, .runs = {}, .panel = 0, .children = {}, .blocks = {}});
    zeros.push_back(0);
    // Join with the supernode before while that wastes little: a wider panel is read and multiplied faster.
    while (supernodes_.size() > 1) {
      auto& last = supernodes_.back();
      const auto& previous = supernodes_[supernodes_.size() - 2];
      const int its_parent = parent[previous.first + previous.columns - 1];
      if (its_parent < last.first || its_parent >= last.first + last.columns) break;
      const double columns = last.columns + previous.columns, rows_below = static_cast<double>(last.rows.size());
      const double more = size(columns, rows_below) - size(last.columns, rows_below) -
                          size(previous.columns, static_cast<double>(previous.rows.size()));
      const double wasted = zeros.back() + zeros[zeros.size() - 2] + more;
      const double most = columns <= 4 ? 0.4 : columns <= 16 ? 0.15 : 0.05;
      if (wasted > most * size(columns, rows_below)) break;
      last.first = previous.first;
      last.columns = static_cast<int>(columns);
      zeros[zeros.size() - 2] = wasted;
      zeros.pop_back();
      supernodes_.erase(supernodes_.end() - 2);
    }
  }
}

void BlockCholesky::place_blocks(const BlockPattern& pattern) {
  std::vector<int> owner(nodes_);
  for (std::size_t s = 0; s < supernodes_.size(); ++s)
    for (int j = 0; j < supernodes_[s].columns; ++j) owner[supernodes_[s].first + j] = static_cast<int>(s);
  // Row of node i in the front of a supernode, which begins with its own columns.
  const auto front_row = [](const Supernode& node, int i) {
    if (i < node.first + node.columns) return i - node.first;
    return node.columns + static_cast<int>(std::ranges::lower_bound(node.rows, i) - node.rows.begin());
  };
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    Supernode& child = supernodes_[s];
    if (child.rows.empty()) continue;
    Supernode& parent = supernodes_[owner[child.rows.front()]];
    parent.children.push_back(static_cast<int>(s));
    for (int row = 0; row < static_cast<int>(child.rows.size()); ++row) {
      const int in_parent = front_row(parent, child.rows[row]);
      if (child.runs.empty() || in_parent != child.runs.back().in_parent + row - child.runs.back().first)
        child.runs.push_back({row, row, in_parent});
      child.runs.back().last = row + 1;
    }
  }
  std::size_t block = 0;
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at, ++block) {
      const int i = position_[row], j = position_[pattern.columns[at]];
      Supernode& node = supernodes_[owner[std::min(i, j)]];
      node.blocks.push_back({block, front_row(node, std::max(i, j)), std::min(i, j) - node.first, i < j});
    }
}

void BlockCholesky::assemble(const Supernode& node, std::span<const float> values, float* panel) {
  const std::size_t stride = node.stride();
  std::fill_n(panel, stride * node.width(), 0.0F);
  for (const auto& [block, row, column, turned] : node.blocks) {
    const float* value = &values[9 * static_cast<std::size_t>(block)];
    float* to = panel + 3 * (static_cast<std::size_t>(column) * stride + static_cast<std::size_t>(row));
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) to[j * stride + i] = turned ? value[3 * j + i] : value[3 * i + j];
  }
}

void BlockCholesky::add_child(const Supernode& child, const float* update, const Supernode& node, float* panel,
                              float* front) {
  const std::size_t size = 3 * child.rows.size(), own = node.width(), rest = node.height() - own;
  for (auto run = child.runs.begin(); run != child.runs.end(); ++run)
    for (int row = run->first; row < run->last; ++row)
      for (std::size_t j = 0; j < 3; ++j) {
        const std::size_t column = 3 * static_cast<std::size_t>(run->in_parent + row - run->first) + j;
        const float* from = update + (3 * static_cast<std::size_t>(row) + j) * size;
        float* to = column < own ? panel + column * node.stride() : front + (column - own) * rest - own;
        for (auto below = run; below != child.runs.end(); ++below) {
          const int first = std::max(row, below->first);
          const float* numbers = from + 3 * first;
          float* sums = to + 3 * (below->in_parent + first - below->first);
#pragma omp simd
          for (int i = 0; i < 3 * (below->last - first); ++i) sums[i] += numbers[i];
        }
      }
}

namespace {

// A = L L^T in place, lower triangle, column-major: halves by BLAS, what is left by hand.
bool dense_cholesky(float* A, int size, int stride) {
  const auto at = [&](int i, int j) -> float& { return A[i + std::size_t(j) * stride]; };
  if (size > 24) {
    const int half = size / 2, rest = size - half;
    const float one = 1, minus = -1;
    if (!dense_cholesky(A, half, stride)) return false;
    strsm_("R", "L", "T", "N", &rest, &half, &one, A, &stride, &at(half, 0), &stride);
    ssyrk_("L", "N", &rest, &half, &minus, &at(half, 0), &stride, &one, &at(half, half), &stride);
    return dense_cholesky(&at(half, half), rest, stride);
  }
  for (int j = 0; j < size; ++j) {
    if (!(at(j, j) > 0)) return false;
    const float pivot = std::sqrt(at(j, j));
    for (int i = j; i < size; ++i) at(i, j) /= pivot;
    for (int k = j + 1; k < size; ++k)
      for (int i = k; i < size; ++i) at(i, k) -= at(i, j) * at(k, j);
  }
  return true;
}

}  // namespace

// Panel [A11; A21] to [L11^-1; L21 L11^-1]; the front of what is left to -L21 L21^T + what it was.
bool BlockCholesky::eliminate(const Supernode& node, float* panel, float* front) {
  const BlasUse use;
  const int own = static_cast<int>(node.width()), rest = static_cast<int>(node.height()) - own;
  const int stride = static_cast<int>(node.stride());
  const float one = 1, minus = -1;
  if (!dense_cholesky(panel, own, stride)) return false;
  std::vector<float> inverse(node.width() * node.width());
  for (std::size_t j = 0; j < node.width(); ++j) inverse[j * (node.width() + 1)] = 1;
  strsm_("L", "L", "N", "N", &own, &own, &one, panel, &stride, inverse.data(), &own);
  for (std::size_t j = 0; j < node.width(); ++j)
    std::copy_n(&inverse[j * node.width()], own, panel + j * node.stride());
  if (rest > 0) {
    float* const below = panel + own;  // products with the inverse, not solves: BLAS is faster at them
    strmm_("R", "L", "T", "N", &rest, &own, &one, inverse.data(), &own, below, &stride);
    ssyrk_("L", "N", &rest, &own, &minus, below, &stride, &one, front, &rest);
    strmm_("R", "L", "N", "N", &rest, &own, &one, inverse.data(), &own, below, &stride);
  }
  return true;
}

// Data shared by threads.
struct BlockCholesky::Fronts {
  explicit Fronts(std::size_t supernodes) : updates(supernodes) {}

  std::vector<std::unique_ptr<float[]>> updates;  // of each supernode to its parent: lower triangles, column-major
  std::atomic<bool> has_failed = false;
  std::exception_ptr error;  // of the thread that has set has_failed; null: not positive definite
};

bool BlockCholesky::factorise(std::span<const float> values) {
  const int threads = omp_get_max_threads();
  Fronts fronts(supernodes_.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
#pragma omp single
  for (int s = 0; s < static_cast<int>(supernodes_.size()); ++s)
    if (supernodes_[s].rows.empty()) factorise_subtree(s, values, fronts);
  if (fronts.error) std::rethrow_exception(fronts.error);
  return !fronts.has_failed;
}

// On any thread, the children of a supernode are added in their order, so sums are bitwise identical.
void BlockCholesky::factorise_subtree(int root, std::span<const float> values, Fronts& fronts) {
  constexpr double worth_a_task = 1e6;
  const Supernode& node = supernodes_[root];
  if (node.work < worth_a_task) {
    for (int s = node.subtree; s < root; ++s) factorise_front(s, values, fronts);
  } else {
    for (const int child : node.children) {
#pragma omp task shared(fronts)
      factorise_subtree(child, values, fronts);
    }
#pragma omp taskwait
  }
  factorise_front(root, values, fronts);
}

void BlockCholesky::factorise_front(int s, std::span<const float> values, Fronts& fronts) {
  if (fronts.has_failed) return;
  try {
    const Supernode& node = supernodes_[s];
    const std::size_t rest = node.height() - node.width();
    float* const panel = panels_[node.panel].numbers;
    assemble(node, values, panel);
    std::unique_ptr<float[]>& update = fronts.updates[s];
    update.reset(new float[rest * rest]);
    // From the diagonal's blocks on.
    for (std::size_t j = 0; j < rest; ++j) std::fill_n(&update[j * rest + j / 3 * 3], rest - j / 3 * 3, 0.0F);
    for (const int child : node.children) {
      add_child(supernodes_[child], fronts.updates[child].get(), node, panel, update.get());
      fronts.updates[child].reset();
    }
    if (!eliminate(node, panel, update.get())) fronts.has_failed = true;
  } catch (...) {  // may not leave a task
    if (!fronts.has_failed.exchange(true)) fronts.error = std::current_exception();
  }
}

namespace {

// A node's three numbers, and one that does not matter: nodes are moved between arrays of three and of four numbers a
// node four at a time, in ascending order, so that what is written too much is overwritten by the next.
typedef float FourNumbers __attribute__((vector_size(16)));  // NOLINT: no `using` for attributes
FourNumbers read(const float* numbers) {
  FourNumbers four;
  std::memcpy(&four, numbers, sizeof four);
  return four;
}
void write(float* numbers, FourNumbers four) { std::memcpy(numbers, &four, sizeof four); }

}  // namespace

void BlockCholesky::solve(std::span<float> x) const {
  solve_down(x, z_);
  solve_up(z_, x);
}

template <class Body>
void BlockCholesky::for_branches(const Body& body) const {
#pragma omp parallel for schedule(dynamic) if (branches_.size() > 1)
  for (Part& branch : branches_) body(branch);
}

void BlockCholesky::solve_down(std::span<const float> b, Halfway& z) const {
  z.resize(nodes_);
  for (int n = 0; n < nodes_; ++n) std::copy_n(&b[3 * n], 3, z[position_[n]].numbers);
  const auto go_down = [&](Part& part) {
    for (const int s : part.supernodes) {
      const Supernode& node = supernodes_[s];
      const auto is_zero = [](const NodeNumbers& x) {
        return x.numbers[0] == 0 && x.numbers[1] == 0 && x.numbers[2] == 0;
      };
      if (!std::all_of(&z[node.first], &z[node.first] + node.columns, is_zero)) solve_down(node, part, z);
    }
  };
  const auto rows_above = [&](const Part& branch) -> const std::vector<int>& {
    return supernodes_[branch.supernodes.back()].rows;
  };
  for_branches([&](Part& branch) {
    for (const int row : rows_above(branch)) branch.above[row] = {};
    go_down(branch);
  });
  for (const Part& branch : branches_)
    for (const int row : rows_above(branch))
      write(z[row].numbers, read(z[row].numbers) + read(branch.above[row].numbers));
  go_down(trunk_);
}

void BlockCholesky::solve_up(Halfway& z, std::span<float> x) const {
  const auto go_up = [&](Part& part) {
    for (std::size_t i = part.supernodes.size(); i-- > 0;) solve_up(supernodes_[part.supernodes[i]], part, z);
  };
  go_up(trunk_);
  for_branches(go_up);
  for (int n = 0; n < nodes_; ++n) std::copy_n(z[position_[n]].numbers, 3, &x[3 * n]);
}

void BlockCholesky::solve_down(const Supernode& node, Part& part, Halfway& x) const {
  float* const own = part.own.data();
  float* const front = part.front.data()->numbers;
  for (int k = 0; k < node.columns; ++k) write(own + 3 * k, read(x[node.first + k].numbers));
  products_->multiply(panel_of(node), own, part.front.data());
  for (int k = 0; k < node.columns; ++k) write(x[node.first + k].numbers, read(front + 3 * k));
  float* below = front + node.width();
  for (const int row : node.rows) {
    float* const to = row < part.end ? x[row].numbers : part.above[row].numbers;
    write(to, read(to) - read(below));
    below += 3;
  }
}

void BlockCholesky::solve_up(const Supernode& node, Part& part, Halfway& x) const {
  float* const own = part.own.data();
  float* const front = part.front.data()->numbers;
  for (int k = 0; k < node.columns; ++k) write(front + 3 * k, read(x[node.first + k].numbers));
  float* below = front + node.width();
  for (const int row : node.rows) {
    write(below, -read(x[row].numbers));
    below += 3;
  }
  std::fill(below, front + chunks_for(node.height()) * PanelChunk::size, 0.0F);  // after the last node
  products_->multiply_transposed(panel_of(node), part.front.data(), own);
  for (int k = 0; k < node.columns; ++k) write(x[node.first + k].numbers, read(own + 3 * k));
}

}  // namespace plica
