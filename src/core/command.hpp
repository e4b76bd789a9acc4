// Execution of other programs.
#pragma once

#include <string>
#include <vector>

namespace plica {

struct CommandResult {
  int status = -1;     // -1: not started, or killed
  std::string output;  // its stdout and stderr
};

/// Run a program found on PATH, without a shell, and wait for it.
CommandResult run_command(const std::vector<std::string>& words);

}  // namespace plica
