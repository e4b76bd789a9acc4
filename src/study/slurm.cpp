#include "study/slurm.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/numbers.hpp"
#include "study/csv_fields.hpp"
#include "study/run_study.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

constexpr double task_s = 600;            // target duration of a task: long compared with its start by Slurm
constexpr std::size_t least_tasks = 8;    // also for short runs: for as many machines
constexpr std::size_t most_tasks = 1000;  // Slurm's usual largest array
constexpr int most_restarts = 20;         // of a task that runs into its limit
constexpr int most_resubmissions = 2;     // of runs without a result

fs::path folder(const StudyDirectory& directory) { return fs::absolute(directory.path()) / "slurm"; }

std::string in_shell(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "'\\''" : std::string(1, c);
  return quoted + "'";
}

// `plica study WHAT` of the study in the directory above.
std::string program(const fs::path& folder, const char* what) {
  return fmt::format("{} study {} {}", in_shell(fs::read_symlink("/proc/self/exe").string()), what,
                     in_shell(folder.parent_path().string()));
}

// When Slurm's limit is near or Slurm preempts the task, plica stops in order, and an unfinished task is queued again.
std::string task_script(const fs::path& folder, const SlurmSubmission& plan) {
  return fmt::format(R"(#!/bin/bash
#SBATCH --job-name=plica-study
#SBATCH --requeue --open-mode=append --signal=B:USR1@60
#SBATCH --ntasks=1 --cpus-per-task=1 --time={} --mem={}M
ended() {{ kill -TERM "$child" 2>/dev/null; wait "$child"; }}
again() {{
  ended
  [ "${{SLURM_RESTART_COUNT:-0}}" -ge {} ] || scontrol requeue "${{SLURM_ARRAY_JOB_ID}}_$SLURM_ARRAY_TASK_ID"
  exit 0
}}
trap again USR1
trap 'ended; exit 143' TERM
export OMP_NUM_THREADS=1
{} --task "$SLURM_ARRAY_TASK_ID" & child=$!  # bash handles signals only while it waits
wait "$child"
)",
                     plan.limit_min, plan.memory_MB, most_restarts, program(folder, "work"));
}

std::string gather_script(const fs::path& folder) {
  return fmt::format(R"(#!/bin/bash
#SBATCH --job-name=plica-gather
#SBATCH --requeue --open-mode=append
#SBATCH --ntasks=1 --cpus-per-task=1 --time=60
export OMP_NUM_THREADS=1
exec {}
)",
                     program(folder, "gather"));
}

std::string submit(std::vector<std::string> words, const std::vector<std::string>& sbatch) {
  words.insert(words.begin(), {"sbatch", "--parsable"});
  words.insert(words.begin() + 2, sbatch.begin(), sbatch.end());
  const CommandResult result = run_command(words);
  if (result.status == -1) throw UsageError("sbatch cannot be run; submit from a machine that has Slurm's commands");
  std::string number = result.output.substr(0, result.output.find_first_of(";\n"));
  if (result.status != 0 || !number_in(number))
    throw UsageError("Slurm rejected the study: " + result.output.substr(0, result.output.find_last_not_of('\n') + 1));
  return number;
}

Json jobs_in(const StudyDirectory& directory) {
  try {
    return Json::parse(read_file(folder(directory) / "jobs.json"));
  } catch (const std::exception&) {
    throw FileError((folder(directory) / "jobs.json").string() +
                    ": cannot be read; submit the study with --engine slurm first");
  }
}

void submit_open(const StudyDirectory& directory, const std::vector<std::string>& sbatch, int attempt,
                 SlurmSubmission& plan) {
  const std::vector<std::size_t> open = directory.open_runs();
  const fs::path here = folder(directory);
  plan.runs = open.size();
  const auto in_tasks = [&](std::size_t tasks) { return (open.size() + tasks - 1) / tasks; };  // runs of each
  const auto fitting = static_cast<std::size_t>(std::max(1.0, task_s / std::max(plan.run_s, 1e-3)));
  plan.runs_a_task = std::max(std::min(fitting, in_tasks(least_tasks)), in_tasks(most_tasks));
  plan.tasks = in_tasks(plan.runs_a_task);
  plan.limit_min = 10 + static_cast<int>(std::ceil(3 * plan.run_s * static_cast<double>(plan.runs_a_task) / 60));
  write_file(here / "runs.txt", fmt::format("{}\n{}\n", plan.runs_a_task, fmt::join(open, "\n")));
  write_file(here / "task.sh", task_script(here, plan));
  write_file(here / "gather.sh", gather_script(here));
  std::error_code error;
  fs::remove(here / "ended", error);
  plan.array = submit({fmt::format("--array=0-{}", plan.tasks - 1), "--output=" + (here / "log" / "%A_%a.txt").string(),
                       (here / "task.sh").string()},
                      sbatch);
  plan.gather = submit({"--dependency=afterany:" + plan.array, "--output=" + (here / "log" / "gather_%j.txt").string(),
                        (here / "gather.sh").string()},
                       sbatch);
  const Json jobs = {{"array", plan.array}, {"gather", plan.gather}, {"attempt", attempt},
                     {"sbatch", sbatch},    {"run_s", plan.run_s},   {"memory_MB", plan.memory_MB}};
  write_file(here / "jobs.json", jobs.dump(2) + '\n');
}

}  // namespace

SlurmSubmission submit_to_slurm(const Study& study, StudyDirectory& directory, const std::vector<std::string>& sbatch,
                                const std::function<bool()>& stop) {
  make_directory(folder(directory) / "log");
  std::error_code ignored;
  fs::remove(folder(directory) / "cancelled", ignored);
  SlurmSubmission plan;
  const std::vector<std::size_t> open = directory.open_runs();
  if (!open.empty())
    run_study(study, directory, {}, {open.front()},
              {[&](std::size_t, const std::string& row) {
                 const auto fields = csv_fields(row).front();
                 plan.run_s = number_in(fields[fields.size() - 2]).value_or(0);
               },
               stop});
  rusage used{};
  ::getrusage(RUSAGE_CHILDREN, &used);
  plan.memory_MB = 200 + static_cast<int>(1.5 * static_cast<double>(used.ru_maxrss) / 1024);
  if (stop && stop()) return plan;
  if (open.size() <= 1) {
    write_file(folder(directory) / "ended", "");
    return plan;
  }
  submit_open(directory, sbatch, 0, plan);
  return plan;
}

std::vector<std::size_t> runs_of_task(const StudyDirectory& directory, int task) {
  std::istringstream text(read_file(folder(directory) / "runs.txt"));
  std::size_t runs_a_task = 0;
  text >> runs_a_task;
  std::vector<std::size_t> runs;
  std::size_t place = 0;
  for (std::size_t run = 0; text >> run; ++place)
    if (task >= 0 && runs_a_task > 0 && place / runs_a_task == static_cast<std::size_t>(task)) runs.push_back(run);
  if (runs.empty())
    throw UsageError(fmt::format("--task {}: not a task of the study; give a number of its job array", task));
  return runs;
}

std::string go_on_on_slurm(const StudyDirectory& directory) {
  const std::size_t missing = directory.open_runs().size();
  const Json jobs = jobs_in(directory);
  const int attempt = jobs.value("attempt", 0);
  const bool is_cancelled = is_there(folder(directory) / "cancelled");
  if (missing > 0 && !is_cancelled && attempt < most_resubmissions) {
    SlurmSubmission plan;
    plan.run_s = jobs.value("run_s", 0.0), plan.memory_MB = jobs.value("memory_MB", 1000);
    submit_open(directory, jobs.value("sbatch", std::vector<std::string>{}), attempt + 1, plan);
    return fmt::format("{} runs have no result; resubmitted as job {}", missing, plan.array);
  }
  write_file(folder(directory) / "ended", "");
  return missing == 0 ? "all runs have a result" : fmt::format("{} runs have no result", missing);
}

bool was_submitted(const StudyDirectory& directory) { return is_there(folder(directory) / "jobs.json"); }

bool slurm_has_ended(const StudyDirectory& directory) { return is_there(folder(directory) / "ended"); }

void cancel_on_slurm(const StudyDirectory& directory) {
  const Json jobs = jobs_in(directory);
  write_file(folder(directory) / "cancelled", "");
  const CommandResult result = run_command({"scancel", jobs.value("array", ""), jobs.value("gather", "")});
  if (result.status != 0) throw UsageError("scancel failed: " + result.output);
  write_file(folder(directory) / "ended", "");
}

std::string jobs_on_slurm(const StudyDirectory& directory) {
  const Json jobs = jobs_in(directory);
  if (slurm_has_ended(directory)) return "jobs have ended";
  const CommandResult result = run_command({"squeue", "--noheader", "--array", "--format=%T",
                                            "--jobs=" + jobs.value("array", "") + "," + jobs.value("gather", "")});
  if (result.status != 0) return "state of the jobs unknown (squeue failed)";
  std::map<std::string, int> by_state;
  std::istringstream lines(result.output);
  for (std::string state; lines >> state;) ++by_state[state];
  std::vector<std::string> texts;
  texts.reserve(by_state.size());
  for (const auto& [state, count] : by_state) texts.push_back(fmt::format("{} {}", count, state));
  return texts.empty() ? "no jobs left"
                       : fmt::format("jobs {} and {}: {}", jobs.value("array", ""), jobs.value("gather", ""),
                                     fmt::join(texts, ", "));
}

}  // namespace plica
