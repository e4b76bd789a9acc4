// Batch of runs, each in a separate process, so that a crash affects no other run. Starts /proc/self/exe, so works only
// within plica itself. Results are read from DIR/runs/ID.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "study/worker_pool.hpp"

namespace plica {

struct BatchRun {
  std::string id;  // name of its files
  Scenario scenario;
};

/// Exit status and message of a run.
struct BatchOutcome {
  int exit_status = -1;  // of `plica run`; -1: did not start or was killed
  std::string message;   // its stderr
};

/// Run each scenario (DIR/runs/ID.toml), results in DIR/runs/ID, replacing earlier ones. Runs start in order; outcomes
/// are in the order of the runs. `tell` is called after each run with their number so far. Once `interrupted` is true,
/// runs under way are terminated and no more start. Throws FileError if DIR cannot be written.
std::vector<BatchOutcome> run_batch(const std::filesystem::path& directory, const std::vector<BatchRun>& runs,
                                    Workers workers,
                                    const std::function<void(std::size_t done, const BatchRun& run)>& tell,
                                    const std::function<bool()>& interrupted);

}  // namespace plica
