// Iterations and time of conjugate gradients with the multigrid preconditioner on systems of plica's own steps: refined
// elements, and more cells, of about 10 000, 50 000 and 200 000 elements; with --million a sheet of that many cells.
// docs/decisions/0007-multigrid.md.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "solver/algebra/linear_solver.hpp"
#include "systems.hpp"

namespace {

using namespace plica;
using namespace plica::multigrid_bench;

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void multiply(const System& system, const std::vector<double>& x, std::vector<double>& y) {
  std::fill(y.begin(), y.end(), 0.0);
  const auto& [starts, columns] = system.pattern;
  for (int row = 0; row < system.pattern.nodes(); ++row)
    for (int place = starts[row]; place < starts[row + 1]; ++place) {
      const float* a = &system.values[9 * static_cast<std::size_t>(place)];
      const std::size_t r = 3 * static_cast<std::size_t>(row), c = 3 * static_cast<std::size_t>(columns[place]);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          y[r + i] += a[3 * i + j] * x[c + j];
          if (r != c) y[c + j] += a[3 * i + j] * x[r + i];
        }
    }
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
  return sum;
}

struct Result {
  int iterations = 0;
  double analysis_s = 0, setup_s = 0, cycle_s = 0;
};

// From a right side of noise to a residual of 1e-6.
Result solve(const System& system) {
  Result result;
  const double begin = seconds();
  const auto multigrid = make_multigrid(system.pattern);
  const double made = seconds();
  if (!multigrid->factorise(system.values, system.near_kernel)) {
    std::fprintf(stderr, "not positive definite\n");
    std::exit(1);
  }
  result.analysis_s = made - begin;
  result.setup_s = seconds() - made;

  const std::size_t size = 3 * static_cast<std::size_t>(system.pattern.nodes());
  std::vector<double> r(size), p(size, 0.0), Ap(size), last(size, 0.0), z(size);
  std::vector<float> preconditioned(size);
  unsigned state = 7;
  for (double& value : r) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<double>(state >> 8) / (1 << 24) - 0.5;
  }
  const double start = dot(r, r);
  double rz = 0;
  while (dot(r, r) > 1e-12 * start && result.iterations < 500) {
    std::copy(r.begin(), r.end(), preconditioned.begin());
    const double before = seconds();
    multigrid->solve(preconditioned);
    result.cycle_s += seconds() - before;
    std::copy(preconditioned.begin(), preconditioned.end(), z.begin());
    const double next = dot(r, z), beta = rz == 0 ? 0 : (next - dot(last, z)) / rz;
    rz = next;
    for (std::size_t n = 0; n < size; ++n) p[n] = z[n] + beta * p[n];
    multiply(system, p, Ap);
    const double alpha = rz / dot(p, Ap);
    last = r;
    for (std::size_t n = 0; n < size; ++n) r[n] -= alpha * Ap[n];
    ++result.iterations;
  }
  result.cycle_s /= std::max(1, result.iterations);
  return result;
}

void print(const char* way, const SystemSettings& settings) {
  const System system = make_system(settings);
  const Result result = solve(system);
  std::printf("%-8s %8zu %8d %6g %5d %6s %4d %9.3f %8.3f %9.4f %9.3f\n", way, system.elements, system.pattern.nodes(),
              settings.step_s, static_cast<int>(settings.bulk_modulus), settings.free_of == 0 ? "shell" : "free",
              result.iterations, result.analysis_s, result.setup_s, result.cycle_s,
              1e6 * (result.setup_s / 3 + result.iterations * result.cycle_s) / static_cast<double>(system.elements));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const bool large = argc > 1 && std::string(argv[1]) == "--million";
  std::printf("way      elements    nodes step_s kappa  nodes   it analysis_s  setup_s   cycle_s us/element\n");
  if (large) {
    print("cells", {.scale = 36});
    return 0;
  }
  for (const double step : {0.05, 5.0, 15.0})
    for (const int free_of : {0, 1}) {
      for (const int refinement : {2, 4, 6})
        print("refined",
              {.elements_per_cell = {refinement, refinement, refinement}, .step_s = step, .free_of = free_of});
      for (const int scale : {4, 8, 16}) print("cells", {.scale = scale, .step_s = step, .free_of = free_of});
    }
}
