#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "core/errors.hpp"
#include "paper/reproduce.hpp"

namespace plica {
namespace {

struct ReproduceCommand {
  std::string out;
  bool quick = false, overwrite = false, quiet = false;
  int at_a_time = 2;
};

// Results are written over with --overwrite only; nothing is removed.
void require_no_results(const std::filesystem::path& out, bool overwrite) {
  namespace fs = std::filesystem;
  if (out.empty()) throw UsageError("--out is empty; give the directory for the results");
  std::error_code error;
  if (fs::exists(out, error) && !fs::is_directory(out, error))
    throw FileError(out.string() + ": is a file, not a directory; give another --out");
  for (const char* name : {"reproduction.md", "reproduction.html", "runs", "figures"})
    if (!overwrite && fs::exists(out / name, error))
      throw FileError(out.string() + ": holds results already; give another --out, or --overwrite to replace them");
}

// A line that changes on a terminal; when piped, one every ten seconds.
class BatchProgress {
 public:
  explicit BatchProgress(bool quiet) : quiet_(quiet), on_terminal_(::isatty(STDERR_FILENO) != 0) {}

  void show(std::size_t done, std::size_t count, const std::string& id) {
    if (quiet_) return;
    const auto now = Clock::now();
    const auto seconds = [&](Clock::time_point since) { return std::chrono::duration<double>(now - since).count(); };
    if (!on_terminal_ && done < count && seconds(last_) < 10) return;
    last_ = now;
    const std::string line = fmt::format("{} of {} runs done in {:.0f} s; last: {}", done, count, seconds(start_), id);
    if (on_terminal_)
      fmt::print(stderr, "\r{:<78}{}", line, done == count ? "\n" : "");
    else
      fmt::print(stderr, "{}\n", line);
  }

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, on_terminal_;
  Clock::time_point start_ = Clock::now(), last_ = start_;
};

int reproduce_paper(const ReproduceCommand& command) {
  require_no_results(command.out, command.overwrite);
  catch_interruptions();
  BatchProgress progress(command.quiet);
  const ReproduceOutcome outcome = reproduce(
      {command.out, command.quick, command.at_a_time},
      [&](std::size_t done, std::size_t count, const std::string& id) { progress.show(done, count, id); }, interrupted);
  if (outcome.interrupted) return interrupted_status();
  for (const std::string& run : outcome.failed_runs) fmt::print(stderr, "plica: a run failed: {}\n", run);
  for (const std::string& figure : outcome.missing_figures) fmt::print(stderr, "plica: missing: {}\n", figure);
  if (!command.quiet)
    fmt::print("{} claims: {} reproduced, {} reproduced under this reading, {} not reproduced\n  {}\n", outcome.claims,
               outcome.reproduced, outcome.under_this_reading,
               outcome.claims - outcome.reproduced - outcome.under_this_reading,
               (std::filesystem::path(command.out) / "reproduction.html").string());
  return outcome.failed_runs.empty() ? exit_done : exit_gave_up;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("reproduce", "run every experiment of the paper; its figures beside ours");
  auto options = std::make_shared<ReproduceCommand>();
  command->add_option("--out,--output,-o", options->out, "directory for the page, its figures and all runs")
      ->required();
  command->add_option("--jobs", options->at_a_time, "runs at a time, each on one thread")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_flag("--quick", options->quick, "a few runs, coarse steps: to see that it works");
  command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->add_flag("--quiet", options->quiet, "no progress and no result on the terminal");
  command->footer(
      "Writes DIR/reproduction.html and DIR/reproduction.md. Takes a few minutes.\n"
      "Example: plica reproduce --out results/reproduction");
  command->callback([options, &status] { status = reproduce_paper(*options); });
}

}  // namespace plica
