// Runs a built-in scenario with the loop of src/simulation/simulation.hpp and prints its processor time as JSON.
// bench/python_step.py compares Python's loop with it.
#include <fmt/format.h>
#include <omp.h>

#include <ctime>
#include <iostream>

#include "core/memory.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

int main(int argc, char** argv) try {
  using namespace plica;
  if (argc != 2) {
    std::cerr << "usage: loop SCENARIO\n";
    return 2;
  }
  keep_freed_memory();  // as plica does
  omp_set_num_threads(1);
  Simulation simulation(load_scenario(find_scenario(argv[1])));
  const std::clock_t begin = std::clock();
  double sum = 0;
  while (simulation.step()) sum += simulation.measures()["furrow_depth_um"].value_or(0);
  const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  fmt::print("{{\"steps\": {}, \"loop_s\": {}, \"sum\": {}}}\n", simulation.steps(), seconds, sum);
  return simulation.status() == RunStatus::failed ? 3 : 0;
} catch (const std::exception& error) {
  std::cerr << "loop: " << error.what() << "\n";
  return 1;
}
