// Parallel loops whose results do not depend on the number of threads: each iteration writes only its own data, and
// sums are formed afterwards in a fixed order.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <exception>
#include <span>
#include <vector>

#include "core/vector.hpp"

namespace plica {

/// Carrier of an exception (such as bad_alloc) out of a parallel region, which exceptions must not leave.
class FirstError {
 public:
  /// Call body() on any thread and keep the first exception of all.
  template <class Body>
  void take(const Body& body) {
    try {
      body();
    } catch (...) {
      if (!has_one_.exchange(true)) error_ = std::current_exception();
    }
  }
  /// Rethrow the kept exception; call after the region.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> has_one_ = false;
  std::exception_ptr error_;
};

/// Value of `worth_sharing` of parallel_for for iterations that take microseconds.
inline constexpr std::size_t long_bodies = 256;

/// Call body(i) for i in [0, count). Iterations must not write to the same place. An exception is rethrown after its
/// thread skips its remaining iterations. Loops shorter than `worth_sharing` stay on one thread: waking others costs
/// more than they save, and a hundred times as much on a busy machine.
template <class Body>
void parallel_for(std::size_t count, const Body& body, std::size_t worth_sharing = 8192) {
  if (count < worth_sharing || omp_get_max_threads() == 1) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  FirstError error;
#pragma omp parallel
  error.take([&] {
    const std::size_t thread = omp_get_thread_num(), threads = omp_get_num_threads();
    for (std::size_t i = count * thread / threads, end = count * (thread + 1) / threads; i < end; ++i) body(i);
  });
  error.rethrow();
}

/// Least i in [0, count) with is_one(i); `count` if there is none.
template <class Predicate>
std::size_t parallel_find(std::size_t count, const Predicate& is_one) {
  std::atomic<std::size_t> least = count;
  parallel_for(count, [&](std::size_t i) {
    if (i >= least.load(std::memory_order_relaxed) || !is_one(i)) return;
    for (std::size_t before = least; i < before && !least.compare_exchange_weak(before, i);) {
    }
  });
  return least;
}

/// Scalar product of two vectors, summed in parts whose bounds do not depend on the threads.
inline double parallel_dot(std::span<const double> a, std::span<const double> b) {
  constexpr std::size_t part = 4096;
  const auto sum = [&](std::size_t first, std::size_t last) {
    // Four independent pairs of lanes in registers, so that additions do not wait for each other.
    using Pair = double __attribute__((vector_size(16)));
    const auto pair = [](const double* numbers) {
      Pair two;
      std::memcpy(&two, numbers, sizeof two);
      return two;
    };
    Pair lanes[4] = {};
    std::size_t i = first;
    for (; i + 8 <= last; i += 8)
#pragma GCC unroll 4
      for (std::size_t k = 0; k < 4; ++k) lanes[k] += pair(&a[i + 2 * k]) * pair(&b[i + 2 * k]);
    double total = 0;
    for (; i < last; ++i) total += a[i] * b[i];
    for (const Pair& two : lanes) total = total + two[0] + two[1];
    return total;
  };
  if (a.size() <= part) return sum(0, a.size());
  std::vector<double> sums((a.size() + part - 1) / part);
  constexpr std::size_t worth_sharing = 16;  // parts
  parallel_for(
      sums.size(), [&](std::size_t k) { sums[k] = sum(k * part, std::min(a.size(), (k + 1) * part)); }, worth_sharing);
  double total = 0;
  for (const double one : sums) total += one;
  return total;
}

/// Dot product of vectors of nodes, summed likewise.
inline double parallel_dot(std::span<const Vec3> a, std::span<const Vec3> b) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  const auto numbers = [](std::span<const Vec3> vectors) {
    return std::span(reinterpret_cast<const double*>(vectors.data()), 3 * vectors.size());
  };
  return parallel_dot(numbers(a), numbers(b));
}

/// Sum of squared lengths, summed as parallel_dot does.
inline double parallel_squared_norm(std::span<const Vec3> vectors) { return parallel_dot(vectors, vectors); }

}  // namespace plica
