// The reference scene, as bench/data/README.md has it, run and timed (docs/developers/performance-benchmarks.md).
#include <omp.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>

#include "stepping.hpp"
#include "yardstick.hpp"

namespace {

using namespace plica::reference;

struct Options {
  std::filesystem::path mesh;
  int steps = 10, rounds = 9;
  double tolerance = 1e-6;
  std::map<int, std::filesystem::path> positions;  // after how many steps
};

Options read_options(int argc, char** argv) {
  CLI::App app("The reference scene: a contracting shell of hexahedra, step by step. Prints JSON.");
  Options options;
  std::vector<std::string> positions;
  app.add_option("MESH", options.mesh, "Nodes, hexahedra, springs")->required()->check(CLI::ExistingFile);
  app.add_option("--steps", options.steps, "How many")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "True relative residual of every system")
      ->check(CLI::Range(1e-14, 0.1))
      ->capture_default_str();
  app.add_option("--positions", positions, "FILE:STEP, repeatable: compare with these positions after STEP steps");
  app.add_option("--rounds", options.rounds, "Rounds of the yardstick; its median counts")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.footer("Example: reference bench/data/pill756.txt --steps 10 --positions bench/data/pill756_step10.txt:10");
  try {
    app.parse(argc, argv);
    for (const auto& text : positions) {
      const auto colon = text.rfind(':');
      int step = 0;
      if (colon == std::string::npos || !CLI::detail::lexical_cast(text.substr(colon + 1), step) || step < 1 ||
          step > options.steps)
        throw CLI::ValidationError("--positions", text + ": expected FILE:STEP, STEP from 1 to --steps");
      options.positions[step] = text.substr(0, colon);
    }
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

double peak_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

double largest_distance(const std::vector<double>& a, const std::vector<double>& b) {
  double squared = 0;
  for (std::size_t n = 0; n < a.size(); n += 3)
    squared = std::max(squared,
                       std::pow(a[n] - b[n], 2) + std::pow(a[n + 1] - b[n + 1], 2) + std::pow(a[n + 2] - b[n + 2], 2));
  return std::sqrt(squared);
}

void run(const Options& options) {
  const Mesh mesh = read_mesh(options.mesh);
  std::map<int, std::vector<double>> expected;
  for (const auto& [step, file] : options.positions) expected[step] = read_positions(file, mesh.nodes.size() / 3);
  // Before and after: a machine that others use does not keep its speed.
  double yardstick = yardstick_us(mesh, options.rounds) / 2, position_error = 0, seconds = 0, cpu = 0;
  RunReport report;
  {
    const double cpu_before = cpu_seconds();
    auto start = std::chrono::steady_clock::now();
    const auto lap = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
    Stepper stepper(mesh, Settings{}, options.tolerance);
    for (int step = 1; step <= options.steps; ++step) {
      stepper.step();
      if (const auto found = expected.find(step); found != expected.end()) {
        seconds += lap();
        position_error = std::max(position_error, largest_distance(stepper.positions(), found->second));
        start = std::chrono::steady_clock::now();
      }
    }
    seconds += lap();
    cpu = cpu_seconds() - cpu_before;
    report = stepper.report();
  }
  yardstick += yardstick_us(mesh, options.rounds) / 2;

  const double ms_per_step = 1e3 * seconds / options.steps;
  nlohmann::ordered_json result;
  result["mesh"] = options.mesh.filename().string();
  result["hexahedra"] = mesh.hexes.size();
  result["nodes"] = mesh.nodes.size() / 3;
  result["steps"] = options.steps;
  result["tolerance"] = options.tolerance;
  result["ms_per_step"] = ms_per_step;
  result["cpu_ms_per_step"] = 1e3 * cpu / options.steps;
  result["yardstick_us"] = yardstick;
  result["yardsticks_per_step"] = 1e3 * ms_per_step / yardstick;
  result["iterations_per_step"] = static_cast<double>(report.iterations) / options.steps;
  result["preconditioners"] = report.updates;
  result["residual"] = report.residual;
  result["peak_MiB"] = peak_MiB();
  if (!expected.empty()) result["max_position_error"] = position_error;
  std::cout << result.dump(2) << '\n';
}

}  // namespace

int main(int argc, char** argv) {
  const Options options = read_options(argc, argv);
  omp_set_num_threads(1);  // as the program that it is compared with
  try {
    run(options);
  } catch (const FileError& error) {
    std::cerr << error.what() << '\n';
    return 4;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
  return 0;
}
