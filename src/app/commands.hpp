// Subcommands of plica, one file each. Each registers itself on the command line; its callback does the work and sets
// the exit status.
#pragma once

#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <optional>

namespace plica {

/// Exit statuses; part of the public interface.
enum ExitStatus : int {
  exit_done = 0,
  exit_missed = 1,   // an [expect] value was missed
  exit_usage = 2,    // bad usage or scenario
  exit_gave_up = 3,  // the solver failed; state saved
  exit_files = 4,
  exit_interrupted = 130,
  exit_terminated = 143,
};

using AddCommand = void(CLI::App& app, int& status);
AddCommand add_run_command, add_compare_command, add_calibrate_command, add_study_command, add_reproduce_command,
    add_report_command, add_render_command, add_export_command, add_check_command, add_mesh_command,
    add_scenarios_command, add_reference_command, add_studio_command, add_labels_command;

// Ctrl-C and SIGTERM, for commands that stop in good order.
inline volatile std::sig_atomic_t caught_signal = 0;

/// Record SIGINT and SIGTERM instead of ending the program.
inline void catch_interruptions() {
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, [](int caught) { caught_signal = caught; });
}

inline bool interrupted() { return caught_signal != 0; }

/// Whether a signal has arrived and `seconds` have passed since the first call after it. Called often, it gives work
/// under way time to finish.
inline bool interrupted_for(double seconds) {
  using Clock = std::chrono::steady_clock;
  static std::optional<Clock::time_point> seen;
  if (!interrupted()) return false;
  if (!seen) seen = Clock::now();
  return std::chrono::duration<double>(Clock::now() - *seen).count() >= seconds;
}

inline ExitStatus interrupted_status() { return caught_signal == SIGTERM ? exit_terminated : exit_interrupted; }

}  // namespace plica
