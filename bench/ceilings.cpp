#include "ceilings.hpp"

#include <algorithm>
#include <ctime>

namespace plica::bench {
namespace {

typedef double Lanes2 __attribute__((vector_size(16), may_alias));
typedef double Lanes4 __attribute__((vector_size(32), may_alias));
typedef double Lanes8 __attribute__((vector_size(64), may_alias));

// As many chains as registers allow: more than enough to hide the latency of an operation.
constexpr int chains_of(int lanes) { return lanes == 8 ? 20 : 12; }

// The two loops for registers of one size. (Macros, because a function cannot be given its instruction set by a
// template's argument, and GCC drops a vector's attributes from those.)
#define PLICA_MULTIPLY_ADD(Lanes)                                                                   \
  constexpr int lanes = sizeof(Lanes) / 8, chains = chains_of(lanes);                               \
  Lanes sums[chains], factor = Lanes{} + 0.999999, summand = Lanes{} + 1e-6;                        \
  for (int k = 0; k < chains; ++k) sums[k] = Lanes{} + k;                                           \
  for (long round = 0; round < rounds; ++round)                                                     \
    _Pragma("GCC unroll 20") for (int k = 0; k < chains; ++k) sums[k] = sums[k] * factor + summand; \
  double total = 0;                                                                                 \
  for (int k = 0; k < chains; ++k)                                                                  \
    for (int lane = 0; lane < lanes; ++lane) total += sums[k][lane];                                \
  return total;

#define PLICA_SUM(Lanes)                                                    \
  constexpr int lanes = sizeof(Lanes) / 8, chains = 8;                      \
  Lanes sums[chains] = {};                                                  \
  for (std::size_t i = 0; i + chains * lanes <= count; i += chains * lanes) \
    _Pragma("GCC unroll 8") for (int k = 0; k < chains; ++k) sums[k] +=     \
        *reinterpret_cast<const Lanes*>(values + i + k * lanes);            \
  double total = 0;                                                         \
  for (int k = 0; k < chains; ++k)                                          \
    for (int lane = 0; lane < lanes; ++lane) total += sums[k][lane];        \
  return total;

double multiply_add_generic(long rounds) { PLICA_MULTIPLY_ADD(Lanes2) }
double sum_generic(const double* values, std::size_t count) { PLICA_SUM(Lanes2) }
#ifdef __x86_64__
[[gnu::target("avx2,fma")]] double multiply_add_avx2(long rounds) { PLICA_MULTIPLY_ADD(Lanes4) }
[[gnu::target("avx2,fma")]] double sum_avx2(const double* values, std::size_t count) { PLICA_SUM(Lanes4) }
[[gnu::target("avx512f,fma")]] double multiply_add_avx512(long rounds) { PLICA_MULTIPLY_ADD(Lanes8) }
[[gnu::target("avx512f,fma")]] double sum_avx512(const double* values, std::size_t count) { PLICA_SUM(Lanes8) }
#endif

struct Loops {
  int lanes;
  double (*multiply_add)(long);
  double (*sum)(const double*, std::size_t);
};

Loops loops_for(Kernels kernels) {
#ifdef __x86_64__
  if (kernels == Kernels::avx2) return {4, multiply_add_avx2, sum_avx2};
  if (kernels == Kernels::avx512) return {8, multiply_add_avx512, sum_avx512};
#endif
  return {2, multiply_add_generic, sum_generic};
}

// Seconds of work(thread), all threads at once.
template <class Work>
double seconds_of_all(int threads, const Work& work) {
  return seconds(threads, [&] {
#pragma omp parallel for num_threads(threads) schedule(static)
    for (int thread = 0; thread < threads; ++thread) {
      volatile double result = work(thread);
      (void)result;
    }
  });
}

}  // namespace

double now(int threads) {
  timespec time;
  clock_gettime(threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double multiply_add_rate(Kernels kernels, int threads) {
  const Loops loops = loops_for(kernels);
  constexpr long rounds = 100'000;
  const double operations = 2.0 * loops.lanes * chains_of(loops.lanes) * static_cast<double>(rounds) * threads;
  return operations / seconds_of_all(threads, [&](int) { return loops.multiply_add(rounds); });
}

Reading::Reading(Kernels kernels, std::size_t bytes, int threads)
    : kernels_(kernels),
      threads_(threads),
      lines_(std::max<std::size_t>(8, bytes / sizeof(Line) / static_cast<std::size_t>(threads) / 8 * 8)),
      values_(lines_ * static_cast<std::size_t>(threads)) {}

double Reading::rate() const {
  const auto repeats = std::max<std::size_t>(1, (32u << 20) / (values_.size() * sizeof(Line)));
  const double bytes = static_cast<double>(repeats * values_.size() * sizeof(Line));
  return bytes / seconds_of_all(threads_, [&](int thread) {
           double sum = 0;
           for (std::size_t k = 0; k < repeats; ++k)
             sum += loops_for(kernels_).sum(values_[lines_ * static_cast<std::size_t>(thread)].values, 8 * lines_);
           return sum;
         });
}

}  // namespace plica::bench
