#include "app/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/names.hpp"
#include "core/numbers.hpp"
#include "core/threads.hpp"
#include "show/run_pictures.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

// Restart the program with the same arguments and short waits of threads, unless the user has set these. Returns if it
// cannot restart.
void restart_with_short_waits(const std::string& scenario) {
#if defined(__linux__) && !defined(__clang__)  // whose OpenMP has another name for it
  if (std::getenv("OMP_WAIT_POLICY") != nullptr || std::getenv("GOMP_SPINCOUNT") != nullptr) return;
  if (std::error_code unknown; is_there(scenario) && !fs::is_regular_file(scenario, unknown)) return;
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string words{std::istreambuf_iterator<char>(file), {}};  // each ends with a 0
  if (words.empty()) return;
  std::vector<char*> arguments;
  for (std::size_t at = 0; at < words.size(); at = words.find('\0', at) + 1) arguments.push_back(&words[at]);
  arguments.push_back(nullptr);
  // Looks, which take microseconds; sleeping at once costs a step up to half its time.
  setenv("GOMP_SPINCOUNT", "2000", 0);
  execv("/proc/self/exe", arguments.data());
#endif
}

}  // namespace

void ScenarioOptions::add_to(CLI::App& command) {
  command.add_option("SCENARIO", name_or_path, "TOML file, or built-in name (`plica scenarios`)")->required();
  command.add_option("--set", overrides, "KEY=VALUE: override a key of the scenario; repeatable")
      ->allow_extra_args(false);
}

CLI::Option* add_out_option(CLI::App& command, std::string& out, const std::string& meaning) {
  return command.add_option("--out,--output,-o", out, meaning);
}

void add_threads_option(CLI::App& command, int& threads, const char* meaning) {
  command.add_option("--threads", threads, meaning)->check(CLI::Range(1, 1024));
}

void add_view_option(CLI::App& command, std::vector<std::string>& chosen) {
  const std::string meaning = fmt::format("views, one row each: {} (default: antero-ventral; open sheets: apical)",
                                          fmt::join(names_of(views()), ", "));
  command.add_option("--view", chosen, meaning)->delimiter(',')->type_name("NAME,...");
}

void add_colour_option(CLI::App& command, std::string& colour, const std::string& meaning) {
  command.add_option("--color", colour, meaning)->type_name("NAME")->capture_default_str();
  command.add_option("--colour", colour)->group("");  // British spelling, not shown in the help
}

void require_free(const std::string& file, bool overwrite) {
  std::error_code error;
  if (fs::is_directory(file, error)) throw FileError(file + ": is a directory; give the name of a file");
  if (!overwrite && is_there(file))
    throw FileError(file + ": already exists; give another --out, or --overwrite to replace it");
}

void require_new(const std::string& out, const std::vector<const char*>& endings, bool overwrite) {
  if (std::ranges::none_of(endings, [&](const char* ending) { return out.ends_with(ending); }))
    throw UsageError(fmt::format("--out {}: the file's name must end in {}", out, fmt::join(endings, ", or in ")));
  require_free(out, overwrite);
}

std::optional<double> seconds_in(const std::string& time) {
  if (time == "last") return {};
  const double unit_s = time.ends_with("min") ? 60 : 1;
  const std::size_t unit_letters = time.ends_with("min") ? 3 : time.ends_with('s') ? 1 : 0;
  const auto value = number_in(std::string_view(time).substr(0, time.size() - unit_letters));
  if (!value) throw UsageError(fmt::format("--time {}: not a time; give 5min, 300s, 300 (seconds) or last", time));
  return *value * unit_s;
}

double snapshot_time_s(const std::string& time, const std::vector<double>& times_s) {
  const auto wanted_s = seconds_in(time);
  const auto found_s = wanted_s ? nearest_time_s(times_s, *wanted_s) : times_s.back();
  if (!found_s)
    throw UsageError(
        fmt::format("--time {}: the run has snapshots from {:.4g} s to {:.4g} s; give a time in this range", time,
                    times_s.front(), times_s.back()));
  return *found_s;
}

void use_threads(int asked, std::size_t elements, const std::string& scenario) {
  const int threads = threads_for(asked, elements);
  if (threads > 1) restart_with_short_waits(scenario);
  omp_set_num_threads(threads);
}

}  // namespace plica
