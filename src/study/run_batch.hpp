// Many runs of this program, each in a process of its own, some at a time, so that one that crashes takes no other with
// it. It starts /proc/self/exe: from plica itself only. What a run came to is read from DIR/runs/ID.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace plica {

struct BatchRun {
  std::string id;  // names its files
  Scenario scenario;
};

/// How a run ended.
struct BatchOutcome {
  int exit_status = -1;  // of `plica run`; -1: did not start or was killed
  std::string message;   // what it said on stderr
};

/// Runs each scenario: DIR/runs/ID.toml, results in DIR/runs/ID, over those that lie there. The first runs start first;
/// outcomes are in the order of the runs. `tell` hears of each run that ends: how many have, and which. `interrupted`
/// ends those under way, and the rest are not started. FileError when DIR cannot be written.
std::vector<BatchOutcome> run_batch(const std::filesystem::path& directory, const std::vector<BatchRun>& runs,
                                    int at_a_time,
                                    const std::function<void(std::size_t done, const BatchRun& run)>& tell,
                                    const std::function<bool()>& interrupted);

}  // namespace plica
