#include "ceilings.hpp"

#include <algorithm>
#include <chrono>
#include <memory>

namespace plica::bench {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The loops, with vectors of one size. Twelve chains and more hide the latency of an operation on any machine there is.
typedef double Lanes2 __attribute__((vector_size(16), may_alias));
typedef double Lanes4 __attribute__((vector_size(32), may_alias));
typedef double Lanes8 __attribute__((vector_size(64), may_alias));

template <class Lanes>
struct Loops {
  static constexpr std::size_t lanes = sizeof(Lanes) / sizeof(double);
  static constexpr int chains = lanes == 8 ? 20 : 12;

  [[gnu::always_inline]] static inline double multiply_add(long rounds) {
    Lanes sums[chains], factor = Lanes{} + 0.999999, summand = Lanes{} + 1e-6;
    for (int k = 0; k < chains; ++k) sums[k] = Lanes{} + k;
    for (long round = 0; round < rounds; ++round)
#pragma GCC unroll 32
      for (int k = 0; k < chains; ++k) sums[k] = sums[k] * factor + summand;
    double total = 0;
    for (int k = 0; k < chains; ++k)
      for (std::size_t lane = 0; lane < lanes; ++lane) total += sums[k][lane];
    return total;
  }

  [[gnu::always_inline]] static inline double sum(const double* values, std::size_t count) {
    constexpr int parallel = 8;
    Lanes sums[parallel] = {};
    for (std::size_t i = 0; i + parallel * lanes <= count; i += parallel * lanes)
#pragma GCC unroll 8
      for (int k = 0; k < parallel; ++k) sums[k] += *reinterpret_cast<const Lanes*>(values + i + k * lanes);
    double total = 0;
    for (const Lanes& each : sums)
      for (std::size_t lane = 0; lane < lanes; ++lane) total += each[lane];
    return total;
  }
};

using MultiplyAdd = double (*)(long);
using Sum = double (*)(const double*, std::size_t);

double multiply_add_generic(long rounds) { return Loops<Lanes2>::multiply_add(rounds); }
double sum_generic(const double* values, std::size_t count) { return Loops<Lanes2>::sum(values, count); }
#ifdef PLICA_X86_KERNELS
[[gnu::target("avx2,fma")]] double multiply_add_avx2(long rounds) { return Loops<Lanes4>::multiply_add(rounds); }
[[gnu::target("avx2,fma")]] double sum_avx2(const double* v, std::size_t count) { return Loops<Lanes4>::sum(v, count); }
[[gnu::target("avx512f,fma")]] double multiply_add_avx512(long rounds) { return Loops<Lanes8>::multiply_add(rounds); }
[[gnu::target("avx512f,fma")]] double sum_avx512(const double* v, std::size_t count) { return Loops<Lanes8>::sum(v, count); }
#endif

MultiplyAdd multiply_add_for(Kernels kernels) {
#ifdef PLICA_X86_KERNELS
  if (kernels == Kernels::avx2) return multiply_add_avx2;
  if (kernels == Kernels::avx512) return multiply_add_avx512;
#endif
  return multiply_add_generic;
}

Sum sum_for(Kernels kernels) {
#ifdef PLICA_X86_KERNELS
  if (kernels == Kernels::avx2) return sum_avx2;
  if (kernels == Kernels::avx512) return sum_avx512;
#endif
  return sum_generic;
}

// The most work a second that `work()` does, all threads at once, over some rounds.
template <class Work>
double best_rate(double amount, int threads, const Work& work) {
  double best = 0;
  for (int round = 0; round < 25; ++round) {
    const auto start = std::chrono::steady_clock::now();
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int thread = 0; thread < threads; ++thread) {
      volatile double result = work(thread);
      (void)result;
    }
    best = std::max(best, amount / seconds_since(start));
  }
  return best;
}

}  // namespace

double multiply_add_rate(Kernels kernels, int threads) {
  constexpr long rounds = 50'000;
  const int lanes = kernels == Kernels::avx512 ? 8 : kernels == Kernels::avx2 ? 4 : 2;
  const int chains = kernels == Kernels::avx512 ? Loops<Lanes8>::chains : Loops<Lanes4>::chains;
  const double operations = 2.0 * lanes * chains * static_cast<double>(rounds) * threads;
  return best_rate(operations, threads, [&](int) { return multiply_add_for(kernels)(rounds); });
}

double read_bandwidth(Kernels kernels, std::size_t bytes, int threads) {
  constexpr std::size_t step = 64;  // numbers; reads are of whole steps
  const std::size_t count = std::max(bytes / sizeof(double) / threads / step, std::size_t{1}) * step;
  struct alignas(64) Line {
    double values[8];
  };
  const auto values = std::make_unique<Line[]>(count / 8 * threads);
  // Some milliseconds a round, so that starting threads does not matter.
  const int repeats = static_cast<int>(std::max<std::size_t>(1, (8u << 20) / (count * sizeof(double) * threads)));
  const double total = static_cast<double>(count * sizeof(double)) * threads * repeats;
  return best_rate(total, threads, [&](int thread) {
    const double* mine = values[count / 8 * thread].values;
    double sum = 0;
    for (int k = 0; k < repeats; ++k) sum += sum_for(kernels)(mine, count);
    return sum;
  });
}

}  // namespace plica::bench
