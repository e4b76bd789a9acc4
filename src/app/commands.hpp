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

void add_run_command(CLI::App& app, int& status);
void add_compare_command(CLI::App& app, int& status);
void add_calibrate_command(CLI::App& app, int& status);
void add_study_command(CLI::App& app, int& status);
void add_reproduce_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);
void add_render_command(CLI::App& app, int& status);
void add_export_command(CLI::App& app, int& status);
void add_check_command(CLI::App& app, int& status);
void add_mesh_command(CLI::App& app, int& status);
void add_scenarios_command(CLI::App& app, int& status);
void add_reference_command(CLI::App& app, int& status);

}  // namespace plica
