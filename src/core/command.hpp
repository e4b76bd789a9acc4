// Other programs, run and listened to.
#pragma once

#include <string>
#include <vector>

namespace plica {

struct CommandResult {
  int status = -1;     // -1: could not be started, or was killed
  std::string output;  // what it printed, on stdout and stderr
};

/// Runs a program that is found by PATH, without a shell, and waits for it.
CommandResult run_command(const std::vector<std::string>& words);

}  // namespace plica
