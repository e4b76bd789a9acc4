#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "app/progress.hpp"
#include "app/threads.hpp"
#include "core/errors.hpp"
#include "core/threads.hpp"
#include "core/words.hpp"
#include "experiments/page.hpp"
#include "paper/reproduce.hpp"

namespace plica {
namespace {

struct ReproduceCommand {
  std::string what = "paper", out;
  bool quick = false, overwrite = false, quiet = false;
  Workers workers = {.processes = 2};
};

// Refuse a directory with results unless --overwrite; nothing is removed.
void require_no_results(const std::filesystem::path& out, bool overwrite) {
  namespace fs = std::filesystem;
  if (out.empty()) throw UsageError("--out: empty; give the directory for the results");
  std::error_code error;
  if (fs::exists(out, error) && !fs::is_directory(out, error))
    throw FileError(out.string() + ": is a file, not a directory; give another --out");
  for (const char* name : {"reproduction.md", "reproduction.html", "runs", "figures"})
    if (!overwrite && fs::exists(out / name, error))
      throw FileError(out.string() + ": already contains results; give another --out, or --overwrite to replace them");
}

int reproduce_paper(const ReproduceCommand& command) {
  require_no_results(command.out, command.overwrite);
  catch_interruptions();
  std::optional<RunsProgress> progress;
  const ReproduceOutcome outcome = reproduce(
      {command.out, command.quick, command.workers},
      [&](std::size_t done, std::size_t count) {
        if (!progress) progress.emplace(0, count, command.quiet);
        progress->show(done);
      },
      interrupted);
  if (progress) progress->finish();
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

// Print the verdicts of the page in a few lines.
void print_verdicts(const ExperimentResults& results, const ExperimentsPage& page, const std::string& file) {
  std::vector<std::string> texts;
  std::size_t outcomes = 0;
  for (const auto& [verdict, count] : page.verdicts) {
    texts.push_back(fmt::format("{} {}", count, word_of(verdict)));
    outcomes += count;
  }
  fmt::print("{}: {}: {}\n  {}\n", results.experiments().name, plural(outcomes, "outcome"), fmt::join(texts, ", "),
             file);
}

int reproduce_experiments(const ReproduceCommand& command) {
  if (command.out.empty()) throw UsageError("--out: empty; give the directory for the results");
  const std::filesystem::path out = command.out;
  const ThreadCount one(1);
  const Experiments experiments = read_experiments(command.what);
  check_experiments(experiments);
  begin_experiments(out, experiments, command.overwrite);
  ExperimentResults results(experiments, out, command.quick);
  catch_interruptions();
  if (!command.quiet)
    fmt::print(stderr, "{}: {}, {} complete\n", experiments.name, plural(results.runs(), "run"), results.ended());
  RunsProgress progress(results.ended(), results.runs(), command.quiet);
  const auto on_run = [&] { progress.show(results.ended(), results.not_solved().size()); };
  run_experiments(results, command.workers, {on_run, interrupted});
  progress.finish();
  if (interrupted()) {
    fmt::print(stderr, "plica: interrupted; to continue, repeat the command\n");
    return interrupted_status();
  }
  const ExperimentsPage page = experiments_page(results);
  write_document(out, experiments.name, page.document);
  for (const std::string& run : results.not_solved()) fmt::print(stderr, "plica: not solved: {}\n", run);
  for (const std::string& picture : page.missing_pictures) fmt::print(stderr, "plica: missing: {}\n", picture);
  if (!command.quiet) print_verdicts(results, page, (out / (experiments.name + ".html")).string());
  return exit_done;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("reproduce", "run experiments and compare results with observations");
  auto options = std::make_shared<ReproduceCommand>();
  command->add_option("WHAT", options->what, "paper, living (the living embryo), or a file of experiments")
      ->capture_default_str();
  command->add_option("--out,--output,-o", options->out, "directory for the page, figures and runs")->required();
  command->add_option("--jobs", options->workers.processes, "simultaneous runs")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  add_threads_option(*command, options->workers.threads, "threads per run (1)");
  command->add_flag("--quick", options->quick,
                    "paper: few runs, coarse steps; experiments: first draw only, none marked slow");
  command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->add_flag("--quiet", options->quiet, "print only warnings and errors");
  command->footer(
      "Writes DIR/reproduction.html (paper, minutes) or DIR/WHAT.html (experiments, hours).\n"
      "Interrupted experiments continue when the command is repeated.\n"
      "Examples: plica reproduce --out results/reproduction\n"
      "          plica reproduce living --out results/living --jobs 2");
  command->callback([options, &status] {
    status = options->what == "paper" ? reproduce_paper(*options) : reproduce_experiments(*options);
  });
}

}  // namespace plica
