// Takes the first step of the Drosophila contraction in an embryo of a given size and prints its cost as JSON; called
// by bench/run.
#include <fmt/format.h>
#include <omp.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "core/memory.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "simulation/controls.hpp"

namespace {

using namespace plica;

constexpr int exit_done = 0, exit_usage = 2, exit_gave_up = 3;  // as the program's

struct Options {
  int scale = 1;                                // of the embryo, whose cells stay as large as they are
  std::vector<int> elements_per_cell = {1, 1};  // along and across; basal to apical
  double duration_s = 5;
  int threads = 1;
  std::vector<std::string> settings;
};

Options read_options(int argc, char** argv) {
  CLI::App app("The first step of the Drosophila contraction in an embryo of a given size. Prints JSON.");
  Options options;
  app.add_option("--scale", options.scale, "An embryo so many times as long and wide, of cells of the same size")
      ->check(CLI::Range(1, 100))
      ->capture_default_str();
  app.add_option("--elements-per-cell", options.elements_per_cell, "N M: along and across a cell, basal to apical")
      ->expected(2)
      ->check(CLI::Range(1, 100));
  app.add_option("--duration", options.duration_s, "Of the step, s")->check(CLI::PositiveNumber)->capture_default_str();
  app.add_option("--threads", options.threads, "Threads to use")->check(CLI::Range(1, 1024))->capture_default_str();
  app.add_option("--set", options.settings, "key=value of the scenario, repeatable");
  app.footer("Example: step --scale 4 --threads 2");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  return options;
}

Scenario scenario_of(const Options& options) {
  const int k = options.scale, across = options.elements_per_cell[0], layers = options.elements_per_cell[1];
  std::vector<std::string> settings = {
      fmt::format("embryo.cells=[{},{},{}]", 18 * k, 9 * k, 8 * k),
      fmt::format("embryo.length_um={}", 460 * k),
      fmt::format("embryo.diameter_um={}", 280 * k),
      fmt::format("embryo.elements_per_cell=[{0},{0},{1}]", across, layers),
      fmt::format("region.furrow.cells_along={}", 14 * k),
      fmt::format("region.furrow.cells_across={}", 5 * k),
  };
  settings.insert(settings.end(), options.settings.begin(), options.settings.end());
  return load_scenario(find_scenario("drosophila"), settings);
}

double peak_MiB() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

/// Seconds since the last call.
double lap() {
  static auto before = std::chrono::steady_clock::now();
  const auto now = std::chrono::steady_clock::now();
  const double seconds = std::chrono::duration<double>(now - before).count();
  before = now;
  return seconds;
}

/// FNV-1a hash of the positions; equal for bitwise identical results.
std::string checksum(const Vectors& positions) {
  std::uint64_t sum = 14695981039346656037U;
  for (const Vec3& position : positions) {
    std::array<unsigned char, sizeof(Vec3)> bytes;
    std::memcpy(bytes.data(), position.data(), bytes.size());
    for (const unsigned char byte : bytes) sum = (sum ^ byte) * 1099511628211U;
  }
  return fmt::format("{:016x}", sum);
}

/// Separate and never inlined: bench/run counts its instructions by this name.
[[gnu::noinline]] StepReport take_step(const Scenario& scenario, const Model& model, const State& rest,
                                       double duration_s, State& next) {
  return make_stepper(model, make_controls(scenario).scheme)->advance(rest, duration_s, true, next);
}

int run(const Options& options) {
  omp_set_num_threads(options.threads);
  lap();
  const Scenario scenario = scenario_of(options);
  const auto model = make_model(scenario);
  const State rest = rest_state(*model);
  const double model_s = lap(), model_MiB = peak_MiB();
  State next;
  const StepReport report = take_step(scenario, *model, rest, options.duration_s, next);
  const double step_s = lap();
  nlohmann::ordered_json result = {{"elements", model->tissue.elements.size()},
                                   {"cells", model->tissue.cells.size()},
                                   {"nodes", model->tissue.node_count()},
                                   {"threads", options.threads},
                                   {"duration_s", options.duration_s},
                                   {"converged", report.converged()},
                                   {"model_s", model_s},
                                   {"step_s", step_s},
                                   {"newton_iterations", report.newton_iterations},
                                   {"linear_iterations", report.linear_solves},
                                   {"factorisations", report.factorisations},
                                   {"model_MiB", model_MiB},
                                   {"peak_MiB", peak_MiB()}};
  if (report.converged())
    result["checksum"] = checksum(next.positions);
  else
    result["reason"] = report.reason();
  std::cout << result.dump(2) << "\n";
  return report.converged() ? exit_done : exit_gave_up;
}

}  // namespace

int main(int argc, char** argv) try {
  keep_freed_memory();  // as plica does
  return run(read_options(argc, argv));
} catch (const ScenarioError& error) {
  std::cerr << error.what() << "\n";
  return exit_usage;
} catch (const std::exception& error) {
  std::cerr << "step: " << error.what() << "\n";
  return exit_gave_up;
}
