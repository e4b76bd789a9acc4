// Execution of a study on this machine, in several processes.
#pragma once

#include <functional>
#include <vector>

#include "study/study_directory.hpp"
#include "study/worker_pool.hpp"

namespace plica {

struct StudyHooks {
  std::function<void(std::size_t run, const std::string& row)> on_row;  // after each finished run
  std::function<bool()> stop_requested;                                 // polled often; once true, runs are abandoned
};

/// Make the runs of `runs` (empty: all) that have no row yet and add their rows to the directory. Throws FileError if a
/// row cannot be written; nothing is lost then.
void run_study(const Study& study, StudyDirectory& directory, Workers workers, const std::vector<std::size_t>& runs,
               const StudyHooks& hooks);

}  // namespace plica
