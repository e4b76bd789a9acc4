#include "solver/block_cholesky.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/processor.hpp"

extern "C" {  // BLAS
void strsm_(const char* side, const char* triangle, const char* transposed, const char* diagonal, const int* m,
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

std::vector<int> nested_dissection(const BlockPattern& pattern) {
  idx_t n = pattern.nodes();
  Neighbours neighbours(n);
  for (int row = 0; row < n; ++row)
    for (int at = pattern.starts[row]; at < pattern.starts[row + 1] - 1; ++at) {
      neighbours[row].push_back(pattern.columns[at]);
      neighbours[pattern.columns[at]].push_back(row);
    }
  std::vector<idx_t> starts{0}, adjacent, permutation(n), position(n);
  for (const auto& list : neighbours) {
    adjacent.insert(adjacent.end(), list.begin(), list.end());
    starts.push_back(static_cast<idx_t>(adjacent.size()));
  }
  if (adjacent.empty()) {  // METIS wants an edge
    std::vector<int> as_given(n);
    for (int i = 0; i < n; ++i) as_given[i] = i;
    return as_given;
  }
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  if (METIS_NodeND(&n, starts.data(), adjacent.data(), nullptr, options, permutation.data(), position.data()) !=
      METIS_OK)
    throw std::runtime_error("METIS could not order the matrix");
  return {position.begin(), position.end()};
}

}  // namespace

BlockCholesky::BlockCholesky(const BlockPattern& pattern) : nodes_(pattern.nodes()) {
  order(pattern);
  place_blocks(pattern);
  std::size_t size = 0;
  for (auto& node : supernodes_) {
    node.panel = size;
    for (const int row : node.rows) {
      if (node.runs.empty() || row != node.runs.back().first + node.runs.back().second) node.runs.emplace_back(row, 0);
      ++node.runs.back().second;
    }
    size += std::size_t{9} * node.columns * (node.columns + node.rows.size());
    widest_rows_ = std::max(widest_rows_, 3 * (node.columns + node.rows.size()));
  }
  panels_.resize(size);
  x_.resize(3 * static_cast<std::size_t>(nodes_));
  rows_.resize(2 * widest_rows_);
}

void BlockCholesky::order(const BlockPattern& pattern) {
  position_ = nested_dissection(pattern);
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
  for (std::size_t s = 0; s < supernodes_.size(); ++s)
    if (!supernodes_[s].rows.empty())
      supernodes_[owner[supernodes_[s].rows.front()]].children.push_back(static_cast<int>(s));
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at) {
      const int i = position_[row], j = position_[pattern.columns[at]];
      supernodes_[owner[std::min(i, j)]].blocks.push_back(block_rows_.size());
      block_rows_.push_back(std::max(i, j));
      block_columns_.push_back(std::min(i, j));
      block_turned_.push_back(i < j);
    }
}

namespace {

// Row of node i in a front that begins with its own columns.
int front_row(int first, int columns, const std::vector<int>& rows, int i) {
  if (i < first + columns) return i - first;
  return columns + static_cast<int>(std::lower_bound(rows.begin(), rows.end(), i) - rows.begin());
}

}  // namespace

void BlockCholesky::assemble(const Supernode& node, std::span<const float> values, float* panel) const {
  const std::size_t height = 3 * (node.columns + node.rows.size());
  std::fill_n(panel, height * 3 * node.columns, 0.0F);
  for (const std::size_t block : node.blocks) {
    const int row = front_row(node.first, node.columns, node.rows, block_rows_[block]);
    const int column = block_columns_[block] - node.first;
    const float* value = &values[9 * block];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        panel[(3 * column + j) * height + 3 * row + i] = block_turned_[block] ? value[3 * j + i] : value[3 * i + j];
  }
}

void BlockCholesky::add_child(const Supernode& child, const Update& update, const Supernode& node, float* panel,
                              Update& front) const {
  const std::size_t size = 3 * child.rows.size(), height = 3 * (node.columns + node.rows.size());
  const std::size_t own = 3 * static_cast<std::size_t>(node.columns), rest = height - own;
  std::vector<std::size_t> places;
  for (const int i : child.rows) {
    const auto row = static_cast<std::size_t>(front_row(node.first, node.columns, node.rows, i));
    for (std::size_t k = 0; k < 3; ++k) places.push_back(3 * row + k);
  }
  for (std::size_t j = 0; j < size; ++j) {
    const float* from = &update.values[j * size];
    float* to = places[j] < own ? panel + places[j] * height : &front.values[(places[j] - own) * rest] - own;
    for (std::size_t i = j; i < size; ++i) to[places[i]] += from[i];
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
bool BlockCholesky::eliminate(const Supernode& node, float* panel, Update& front) {
  const int own = 3 * node.columns, rest = 3 * static_cast<int>(node.rows.size()), height = own + rest;
  const float one = 1, minus = -1;
  if (!dense_cholesky(panel, own, height)) return false;
  if (rest > 0) {
    strsm_("R", "L", "T", "N", &rest, &own, &one, panel, &height, panel + own, &height);
    ssyrk_("L", "N", &rest, &own, &minus, panel + own, &height, &one, front.values.get(), &rest);
    strsm_("R", "L", "N", "N", &rest, &own, &one, panel, &height, panel + own, &height);
  }
  std::vector<float> inverse(std::size_t(own) * own);
  for (int j = 0; j < own; ++j) inverse[std::size_t(j) * (own + 1)] = 1;
  strsm_("L", "L", "N", "N", &own, &own, &one, panel, &height, inverse.data(), &own);
  for (int j = 0; j < own; ++j) std::copy_n(&inverse[std::size_t(j) * own], own, panel + std::size_t(j) * height);
  return true;
}

bool BlockCholesky::factorise(std::span<const float> values) {
  std::vector<Update> updates(supernodes_.size());
  for (std::size_t s = 0; s < supernodes_.size(); ++s) {
    const auto& node = supernodes_[s];
    float* panel = &panels_[node.panel];
    assemble(node, values, panel);
    const std::size_t rest = 3 * node.rows.size();
    updates[s].values.reset(new float[rest * rest]);
    for (std::size_t j = 0; j < rest; ++j) std::fill_n(&updates[s].values[j * rest + j], rest - j, 0.0F);
    for (const int child : node.children) {
      add_child(supernodes_[child], updates[child], node, panel, updates[s]);
      updates[child].values.reset();
    }
    if (!eliminate(node, panel, updates[s])) return false;
  }
  return true;
}

namespace {

// y = P x; P has `height` rows, column-major, and zeros above the diagonal.
PLICA_FOR_NEWER_PROCESSORS_TOO void multiply(const float* P, int height, int width, const float* x, float* y) {
  std::fill_n(y, height, 0.0F);
  int j = 0;
  for (; j + 6 <= width; j += 6) {
    const float *a = P + std::size_t(j) * height, *b = a + height, *c = b + height, *d = c + height, *e = d + height,
                *f = e + height;
#pragma omp simd
    for (int i = j; i < height; ++i)
      y[i] +=
          (a[i] * x[j] + b[i] * x[j + 1]) + (c[i] * x[j + 2] + d[i] * x[j + 3]) + (e[i] * x[j + 4] + f[i] * x[j + 5]);
  }
  for (; j < width; j += 3) {
    const float *a = P + std::size_t(j) * height, *b = a + height, *c = b + height;
#pragma omp simd
    for (int i = j; i < height; ++i) y[i] += a[i] * x[j] + b[i] * x[j + 1] + c[i] * x[j + 2];
  }
}

// x = P^T y.
PLICA_FOR_NEWER_PROCESSORS_TOO void multiply_transposed(const float* P, int height, int width, const float* y,
                                                        float* x) {
  for (int j = 0; j < width; j += 3) {
    const float *a = P + std::size_t(j) * height, *b = a + height, *c = b + height;
    float p = 0, q = 0, r = 0;
#pragma omp simd reduction(+ : p, q, r)
    for (int i = j; i < height; ++i) {
      p += a[i] * y[i];
      q += b[i] * y[i];
      r += c[i] * y[i];
    }
    x[j] = p;
    x[j + 1] = q;
    x[j + 2] = r;
  }
}

}  // namespace

void BlockCholesky::solve(std::span<float> x) const {
  for (int n = 0; n < nodes_; ++n)
    for (int k = 0; k < 3; ++k) x_[3 * position_[n] + k] = x[3 * n + k];
  float* front = rows_.data();
  for (const auto& node : supernodes_) {
    const int own = 3 * node.columns, height = own + 3 * static_cast<int>(node.rows.size());
    multiply(&panels_[node.panel], height, own, &x_[3 * node.first], front);
    std::copy_n(front, own, &x_[3 * node.first]);
    const float* below = front + own;
    for (const auto& [row, count] : node.runs) {
      float* to = &x_[3 * row];
      for (int k = 0; k < 3 * count; ++k) to[k] -= below[k];
      below += 3 * count;
    }
  }
  for (std::size_t s = supernodes_.size(); s-- > 0;) {
    const auto& node = supernodes_[s];
    const int own = 3 * node.columns, height = own + 3 * static_cast<int>(node.rows.size());
    std::copy_n(&x_[3 * node.first], own, front);
    float* below = front + own;
    for (const auto& [row, count] : node.runs) {
      const float* from = &x_[3 * row];
      for (int k = 0; k < 3 * count; ++k) below[k] = -from[k];
      below += 3 * count;
    }
    multiply_transposed(&panels_[node.panel], height, own, front, &x_[3 * node.first]);
  }
  for (int n = 0; n < nodes_; ++n)
    for (int k = 0; k < 3; ++k) x[3 * n + k] = x_[3 * position_[n] + k];
}

}  // namespace plica
