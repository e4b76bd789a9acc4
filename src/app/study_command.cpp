#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <memory>
#include <thread>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/threads.hpp"
#include "core/words.hpp"
#include "show/report.hpp"
#include "study/run_study.hpp"
#include "study/slurm.hpp"
#include "study/study_report.hpp"

namespace plica {
namespace {

using Clock = std::chrono::steady_clock;

struct StudyOptions {
  std::string study, out, engine = "local";
  int jobs = 0, threads = 1;
  bool resume = false, overwrite = false, quiet = false, wait = false;
  std::vector<std::string> sbatch;
};

std::string by_status(const StudyStatus& status) {
  std::vector<std::string> texts;
  for (const auto& [status_word, count] : status.by_status) texts.push_back(fmt::format("{} {}", count, status_word));
  if (status.ended() < status.runs) texts.push_back(fmt::format("{} not run", status.runs - status.ended()));
  return fmt::format("{}: {}", plural(status.runs, "run"), fmt::join(texts, ", "));
}

void print_reasons(const StudyStatus& status) {
  std::vector<std::pair<std::size_t, std::string>> reasons;
  for (const auto& [reason, count] : status.by_reason) reasons.emplace_back(count, reason);
  std::ranges::sort(reasons, std::greater());
  for (std::size_t r = 0; r < reasons.size() && r < 10; ++r)
    fmt::print("  {:>5} x {}\n", reasons[r].first, reasons[r].second);
  if (reasons.size() > 10) fmt::print("  and {} other reasons\n", reasons.size() - 10);
}

// Write the table and the report of the existing rows.
void write_table(const Study& study, const StudyDirectory& directory) {
  directory.gather(study);
  if (can_report()) write_study_report(directory.path());
}

int ended(const Study& study, const StudyDirectory& directory, const StudyOptions& options, Clock::time_point start) {
  write_table(study, directory);
  if (!options.quiet) {
    const StudyStatus status = status_of(directory, study);
    fmt::print("{}: {} in {}; sum of run times {}\n", study.input().name, by_status(status),
               duration(std::chrono::duration<double>(Clock::now() - start).count()), duration(status.run_s));
    print_reasons(status);
    fmt::print("  table in {0}/runs.csv{1}\n", options.out,
               can_report() ? fmt::format("; open {}/report.html in a browser", options.out) : "");
  }
  if (!interrupted()) return exit_done;
  fmt::print(stderr, "plica: interrupted; to continue, repeat the command with --resume\n");
  return interrupted_status();
}

int run_here(const Study& study, StudyDirectory& directory, const StudyOptions& options, Clock::time_point start) {
  const int jobs = options.jobs > 0
                       ? options.jobs
                       : std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / options.threads);
  StudyStatus status = status_of(directory, study);
  RunsProgress progress(status.ended(), study.runs(), options.quiet);
  const auto on_row = [&](std::size_t, const std::string& row) {
    status.add(row, study);
    progress.show(status.ended(), status.without_result());
  };
  run_study(study, directory, {jobs, options.threads}, {}, {on_row, interrupted});
  progress.finish();
  return ended(study, directory, options, start);
}

int run_on_slurm(const Study& study, StudyDirectory& directory, const StudyOptions& options, Clock::time_point start) {
  if (!options.quiet) fmt::print(stderr, "running the first point on this machine to estimate the cost\n");
  const SlurmSubmission plan = submit_to_slurm(study, directory, options.sbatch, interrupted);
  if (interrupted() || plan.tasks == 0) return ended(study, directory, options, start);
  if (!options.quiet)
    fmt::print(
        "{}: {} in {} of {}, submitted as job {}; job {} collects the results\n"
        "  run time {}; limits of a task: {} min, {} MB\n"
        "  see progress with: plica study status {}; stop it with: plica study cancel {}\n",
        study.input().name, plural(plan.runs, "run"), plural(plan.tasks, "task"), plan.runs_a_task, plan.array,
        plan.gather, duration(plan.run_s), plan.limit_min, plan.memory_MB, options.out, options.out);
  if (!options.wait) return exit_done;
  RunsProgress progress(status_of(directory, study).ended(), study.runs(), options.quiet);
  while (!slurm_has_ended(directory) && !interrupted()) {
    const StudyStatus now = status_of(directory, study);
    progress.show(now.ended(), now.without_result());
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
  progress.finish();
  if (!interrupted()) return ended(study, directory, options, start);
  fmt::print(stderr, "plica: stopped waiting; the jobs continue\n");
  return interrupted_status();
}

int run(const StudyOptions& options) {
  if (options.study.empty()) throw UsageError("STUDY: missing; give STUDY.toml, or see plica study --help");
  if (options.out.empty()) throw UsageError("--out: missing; give the directory for the results");
  if (options.engine == "slurm" && options.threads > 1)
    throw UsageError("--threads: not available with --engine slurm, whose tasks have one thread each; remove it");
  const auto start = Clock::now();
  const ThreadCount one(1);
  const Study study(read_study(options.study));
  if (!options.quiet && !options.resume)
    for (const Diagnostic& note : study.notes()) fmt::print(stderr, "note: {}\n", note.text());
  StudyDirectory directory =
      StudyDirectory::begin(options.out, study, start_of<StudyDirectory::Start>(options.resume, options.overwrite));
  catch_interruptions();
  if (options.resume) write_table(study, directory);  // a killed study left none
  return options.engine == "slurm" ? run_on_slurm(study, directory, options, start)
                                   : run_here(study, directory, options, start);
}

int work(const std::string& out, int task) {
  const ThreadCount one(1);
  auto [directory, study] = StudyDirectory::open_to_run(out);
  catch_interruptions();
  run_study(study, directory, {}, runs_of_task(directory, task), {{}, interrupted});
  return interrupted() ? interrupted_status() : exit_done;
}

void gather(const std::string& out) {
  const ThreadCount one(1);
  auto [directory, study] = StudyDirectory::open_to_run(out);
  write_table(study, directory);
  if (was_submitted(directory)) fmt::print("{}\n", go_on_on_slurm(directory));
}

void print_status(const std::string& out) {
  const auto [directory, study] = StudyDirectory::open(out);
  const StudyStatus status = status_of(directory, study);
  fmt::print("{}: {}; sum of run times so far {}\n", study.input().name, by_status(status), duration(status.run_s));
  print_reasons(status);
  if (was_submitted(directory)) {
    fmt::print("  {}\n", jobs_on_slurm(directory));
  } else if (status.ended() < status.runs) {
    fmt::print("  if it is not running, continue with: plica study {0} --out {1} --resume\n", study.input().file, out);
    fmt::print("  write a table of the finished runs with: plica study gather {}\n", out);
  }
}

void cancel(const std::string& out) { cancel_on_slurm(StudyDirectory::open(out).first); }

}  // namespace

void add_study_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("study", "run a scenario many times with varied keys");
  auto options = std::make_shared<StudyOptions>();
  command->add_option("STUDY", options->study, "TOML file: scenario, varied keys, design");
  add_out_option(*command, options->out, "directory for the table, runs.csv");
  command->add_option("--jobs,-j", options->jobs, "simultaneous runs (default: as many as cores allow)")
      ->check(CLI::Range(1, 4096));
  add_threads_option(*command, options->threads, "threads per run (1)");
  auto* overwrite = command->add_flag("--overwrite", options->overwrite, "replace the study in DIR");
  command->add_flag("--resume", options->resume, "continue the study in DIR; without one, start")->excludes(overwrite);
  command->add_flag("--quiet", options->quiet, "print only warnings and errors");
  command->add_option("--engine", options->engine, "local processes, or a Slurm job array")
      ->check(CLI::IsMember({"local", "slurm"}));
  command->add_option("--sbatch", options->sbatch, "slurm: option for sbatch, as --sbatch=--partition=long; repeatable")
      ->allow_extra_args(false);
  command->add_flag("--wait", options->wait, "slurm: wait for the jobs to end");
  command->footer(
      "Examples: plica study stiffness.toml --out results/stiffness\n          plica study status results/stiffness");

  const auto of_directory = [command](const char* name, const char* what) {
    CLI::App* one = command->add_subcommand(name, what);
    auto out = std::make_shared<std::string>();
    one->add_option("DIR", *out, "directory of a study")->required();
    one->footer(fmt::format("Example: plica study {} results/stiffness{}", name,
                            std::string_view(name) == "work" ? " --task 0" : ""));
    return std::pair(one, out);
  };
  const auto [of_status, status_out] = of_directory("status", "print the progress of a study and its failures");
  of_status->callback([out = status_out] { print_status(*out); });
  const auto [of_cancel, cancel_out] = of_directory("cancel", "cancel its Slurm jobs; finished rows are kept");
  of_cancel->callback([out = cancel_out] { cancel(*out); });
  const auto [of_gather, gather_out] = of_directory("gather", "write runs.csv and report.html from the finished rows");
  of_gather->callback([out = gather_out] { gather(*out); });
  const auto [of_work, work_out] = of_directory("work", "run one task of a job array");
  auto task = std::make_shared<int>(0);
  of_work->add_option("--task", *task, "task number, from 0")->required();
  of_work->callback([out = work_out, task, &status] { status = work(*out, *task); });

  command->callback([options, command, &status] {
    if (command->get_subcommands().empty()) status = run(*options);
  });
}

}  // namespace plica
