// Study on a Slurm cluster: a job array whose tasks make some of the runs each, and a job that collects their rows at
// the end.
//
// All state is in the study's directory, which the machines share: DIR/slurm has the list of runs, both scripts, the
// output of the jobs and their numbers. Jobs may be killed, repeated or run at once: rows are written immediately, and
// a run with a row is not repeated. Rejected: a server or a database that distributes runs.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study_directory.hpp"

namespace plica {

struct SlurmSubmission {
  std::size_t runs = 0, tasks = 0, runs_a_task = 0;
  double run_s = 0;           // measured duration of a run
  int limit_min = 0;          // of a task
  int memory_MB = 0;          // of a task
  std::string array, gather;  // numbers of the jobs
};

/// Make the first run without a row on this machine, to measure its cost, and submit the others, if any. Throws
/// UsageError with the message of Slurm if it rejects the jobs. `sbatch`: its additional options, as --partition=long.
SlurmSubmission submit_to_slurm(const Study& study, StudyDirectory& directory, const std::vector<std::string>& sbatch,
                                const std::function<bool()>& stop);

std::vector<std::size_t> runs_of_task(const StudyDirectory& directory, int task);

/// Resubmit runs without a row, twice at most; called by the last job when the table is written. Returns a
/// sentence about what was done.
std::string go_on_on_slurm(const StudyDirectory& directory);

/// Whether a study was submitted; whether its jobs have ended.
bool was_submitted(const StudyDirectory& directory);
bool slurm_has_ended(const StudyDirectory& directory);

/// Cancel the jobs of a study; existing rows are kept.
void cancel_on_slurm(const StudyDirectory& directory);

/// State of the jobs of a study: "12 RUNNING, 3 PENDING", or that it is unknown.
std::string jobs_on_slurm(const StudyDirectory& directory);

}  // namespace plica
