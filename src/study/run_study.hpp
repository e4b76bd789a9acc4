// Execution of a study on this machine, in several processes; and an estimate of its cost before it starts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study_directory.hpp"
#include "study/worker_pool.hpp"

namespace plica {

struct StudyHooks {
  std::function<void(std::size_t run, const std::string& row)> on_row;  // after each finished run
  std::function<bool()> stop_requested;                                 // polled often; once true, runs are abandoned
};

/// Make the runs of `runs` (in order; empty: all) that have no row yet and add their rows to the directory. Throws
/// FileError if a row cannot be written; nothing is lost then.
void run_study(const Study& study, StudyDirectory& directory, Workers workers, const std::vector<std::size_t>& runs,
               const StudyHooks& hooks);

struct StudyForecast {
  std::size_t runs = 0, points = 0;
  std::vector<std::string> refused;  // invalid points: point and reason
  std::size_t first_run = 0;         // first valid run, which was made
  RunRow first;
  double bytes_a_run = 0;  // on disk
};

/// Check every point and run the first valid one in a temporary directory. `stop`: as in Study::run; when stopped,
/// `first` has no status.
StudyForecast forecast(const Study& study, const std::function<bool()>& stop);

}  // namespace plica
