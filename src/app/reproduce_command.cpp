#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <memory>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/threads.hpp"
#include "core/words.hpp"
#include "experiments/outcomes.hpp"
#include "show/report.hpp"

namespace plica {
namespace {

struct ReproduceCommand {
  std::string what = "paper", out;
  bool quick = false, overwrite = false, quiet = false;
  Workers workers = {.processes = 2};
};

int run_reproduce(const ReproduceCommand& command) {
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
  const OutcomesTable table = outcomes_table(results);
  write_outcomes(results, table);
  for (const std::string& run : results.not_solved()) fmt::print(stderr, "plica: not solved: {}\n", run);
  if (!command.quiet) {
    std::vector<std::string> verdicts;
    for (const auto& [verdict, count] : table.verdicts) verdicts.push_back(fmt::format("{} {}", count, verdict));
    fmt::print("{}{}: {}: {}\n  {}\n", table.for_terminal(), experiments.name, plural(table.rows.size(), "outcome"),
               fmt::join(verdicts, ", "), (out / (can_report() ? "report.html" : "outcomes.csv")).string());
  }
  return exit_done;
}

}  // namespace

void add_reproduce_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("reproduce", "run experiments and compare results with observations");
  auto options = std::make_shared<ReproduceCommand>();
  command->add_option("WHAT", options->what, "paper, living (the living embryo), or a file of experiments")
      ->capture_default_str();
  add_out_option(*command, options->out, "directory for the tables, the report and runs")->required();
  command->add_option("--jobs", options->workers.processes, "simultaneous runs")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  add_threads_option(*command, options->workers.threads, "threads per run (1)");
  command->add_flag("--quick", options->quick, "first draw only, none marked slow");
  command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->add_flag("--quiet", options->quiet, "print only warnings and errors");
  command->footer(
      "Writes DIR/outcomes.csv, DIR/experiments.csv (all draws) and DIR/report.html. The paper takes\n"
      "minutes, the living embryo hours; when repeated, an interrupted command continues.\n"
      "Examples: plica reproduce --out results/reproduction\n"
      "          plica reproduce living --out results/living --jobs 2");
  command->callback([options, &status] { status = run_reproduce(*options); });
}

}  // namespace plica
