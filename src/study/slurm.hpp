// A study on a cluster that Slurm looks after: an array of jobs, each of which runs some of the study's runs, and one
// that gathers their rows when all have ended.
//
// All that is known stands in the study's directory, which the machines share: DIR/slurm has the list of runs, both
// scripts, what the jobs print, and the numbers of the jobs. Jobs may be killed, run twice or at once: rows are written
// as they come, and a run that has one is not begun again. Rejected: a server or a database that hands out runs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/study_directory.hpp"

namespace plica {

struct SlurmOptions {
  std::vector<std::string> sbatch;  // more words for sbatch, as --partition=long
  int retries = 2;                  // how often the job that gathers submits what is missing
};

struct SlurmSubmission {
  std::size_t runs = 0, tasks = 0, runs_a_task = 0;
  double run_s = 0;           // what a run has taken here
  int limit_min = 0;          // of a task
  int memory_MB = 0;          // the same
  std::string array, gather;  // numbers of the jobs
};

/// Runs the first run that has no row here, to see what it takes, and submits the others. Nothing is submitted where no
/// other is left. UsageError when Slurm refuses, with what it says.
SlurmSubmission submit_to_slurm(const Study& study, StudyDirectory& directory, const SlurmOptions& options,
                                const std::function<bool()>& stop);

/// The runs of a task of the array.
std::vector<std::size_t> runs_of_task(const StudyDirectory& directory, int task);

/// What the last job does when the table is written: submits runs without a row once more, `retries` times at most.
/// What it did, in a sentence.
std::string go_on_on_slurm(const Study& study, const StudyDirectory& directory);

/// Whether a study has been submitted; whether that has come to its end.
bool was_submitted(const StudyDirectory& directory);
bool slurm_has_ended(const StudyDirectory& directory);

/// Cancels the jobs of a study; rows that there are stay.
void cancel_on_slurm(const StudyDirectory& directory);

/// What Slurm says of a study's jobs: "12 RUNNING, 3 PENDING"; that it does not know, where it does not answer.
std::string jobs_on_slurm(const StudyDirectory& directory);

}  // namespace plica
