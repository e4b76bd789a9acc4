// Subcommands of plica, one file each. Each registers itself on the command line; its callback does the work and sets
// the exit status.
#pragma once

#include <CLI/CLI.hpp>

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
    add_scenarios_command, add_reference_command;

}  // namespace plica
