// Options and checks shared by commands.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "scenario/load.hpp"

namespace plica {

/// Scenario of a command, with overrides.
struct ScenarioOptions {
  std::string name_or_path;
  std::vector<std::string> overrides;

  void add_to(CLI::App& command);
  [[nodiscard]] Scenario load() const { return load_scenario(find_scenario(name_or_path), overrides); }
};

/// Add --out, --threads, --view, or --color and --colour.
CLI::Option* add_out_option(CLI::App& command, std::string& out, const std::string& meaning);
void add_threads_option(CLI::App& command, int& threads, const char* meaning = "number of threads");
void add_view_option(CLI::App& command, std::vector<std::string>& views);
void add_colour_option(CLI::App& command, std::string& colour, const std::string& meaning);

/// Start of recording in a directory, as RecordedRun::Start.
template <class Start>
Start start_of(bool resume, bool overwrite) {
  return resume ? Start::resumed : overwrite ? Start::over : Start::fresh;
}

/// Check an output file before a command starts. Throws FileError if it is a directory, or exists and `overwrite` is
/// false.
void require_free(const std::string& file, bool overwrite);
/// The same, after the ending of --out. Throws UsageError if it is none of these.
void require_new(const std::string& out, const std::vector<const char*>& endings, bool overwrite);

/// Convert "5min", "300s" or "300" to seconds; empty for "last". Throws UsageError for other text.
std::optional<double> seconds_in(const std::string& time);
/// Time of the snapshot nearest to that of --time. Throws UsageError outside the run.
double snapshot_time_s(const std::string& time, const std::vector<double>& times_s);

/// Set the number of threads: `asked`, else OMP_NUM_THREADS, else as many as the mesh can keep busy. Results do not
/// depend on it.
///
/// May restart the program, so call it before anything is printed or written. GCC's OpenMP lets idle threads spin for
/// milliseconds before they sleep; on a busy machine threads with work wait for these (251 s instead of 19 s,
/// docs/decisions/0015-speed.md). The spin time is read from the environment before main(). `scenario`: file
/// that has been read, or name; no restart for a pipe, which cannot be read twice.
void use_threads(int asked, std::size_t elements, const std::string& scenario);

}  // namespace plica
