// Traversal of all elements with any number of threads: chunks of consecutive elements, coloured so that chunks of one
// colour share no node (including nodes that theirs hang on). Colours run in sequence; the chunks of one colour are
// distributed over threads. Elements thus add to nodes without locks, and sums have the same order for any number of
// threads. Chunks are as long as possible while there are enough to distribute
// (docs/decisions/0015-speed.md).
#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

struct Tissue;

/// View of vectors as x y z each, for kernels.
inline const double* components(std::span<const Vec3> vectors) {
  return reinterpret_cast<const double*>(vectors.data());
}
inline double* components(std::span<Vec3> vectors) { return reinterpret_cast<double*>(vectors.data()); }
static_assert(sizeof(Vec3) == 3 * sizeof(double));

class ElementChunks {
 public:
  /// Number of elements per kernel batch. Chunks begin at multiples of it.
  static constexpr std::size_t batch_size = 8;
  static constexpr std::size_t most_chunks = 64;

  /// Make chunks of `elements` (those of the tissue, or its faces). With their cells, chunks of one colour share no
  /// cell either.
  ElementChunks(const Tissue& tissue, std::span<const std::array<NodeId, 8>> elements,
                std::span<const CellId> element_cell = {});

  [[nodiscard]] std::size_t element_count() const { return elements_; }
  [[nodiscard]] std::size_t batch_count() const { return (elements_ + batch_size - 1) / batch_size; }

  /// Call body(first batch, last batch) for every chunk; `last` is one past the end. On one thread unless `shared`.
  template <class Body>
  void for_batches(const Body& body, bool shared = true) const {
    for_chunks([&](std::size_t chunk) { body(first_batch(chunk), last_batch(chunk)); }, shared);
  }

  /// Call body(element) for every element.
  template <class Body>
  void for_elements(const Body& body, bool shared = true) const {
    for_chunks(
        [&](std::size_t chunk) {
          for (std::size_t e = first_batch(chunk) * batch_size; e < last_element(chunk); ++e) body(e);
        },
        shared);
  }

  /// Return the sum of body(element) over all elements.
  template <class Body>
  [[nodiscard]] double sum_over_elements(const Body& body) const {
    std::array<double, most_chunks> parts = {};
    for_chunks([&](std::size_t chunk) {
      for (std::size_t e = first_batch(chunk) * batch_size; e < last_element(chunk); ++e) parts[chunk] += body(e);
    });
    double sum = 0;
    for (const double part : parts) sum += part;
    return sum;
  }

 private:
  template <class Body>
  void for_chunks(const Body& body, bool shared = true) const {
    constexpr std::size_t worth_sharing = 2048;  // elements; with fewer, waking threads costs more than it saves
    if (!shared || elements_ < worth_sharing || omp_get_max_threads() == 1) {
      for (const std::size_t chunk : order_) body(chunk);
      return;
    }
#pragma omp parallel
    for (std::size_t phase = 0; phase + 1 < phase_start_.size(); ++phase) {
#pragma omp for schedule(dynamic)
      for (std::size_t k = phase_start_[phase]; k < phase_start_[phase + 1]; ++k) body(order_[k]);
    }
  }

  [[nodiscard]] std::size_t first_batch(std::size_t chunk) const { return chunk * batches_in_chunk_; }
  [[nodiscard]] std::size_t last_batch(std::size_t chunk) const {
    return std::min(first_batch(chunk + 1), batch_count());
  }
  [[nodiscard]] std::size_t last_element(std::size_t chunk) const {
    return std::min(last_batch(chunk) * batch_size, elements_);
  }

  std::size_t elements_;
  std::size_t batches_in_chunk_;
  std::vector<std::size_t> order_;        // chunks, colour by colour
  std::vector<std::size_t> phase_start_;  // start of each colour in order_, and the end
};

}  // namespace plica
