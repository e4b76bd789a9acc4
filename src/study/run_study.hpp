// A study on this machine, on as many processes as asked.
#pragma once

#include <functional>
#include <vector>

#include "study/study_directory.hpp"

namespace plica {

struct StudyHooks {
  std::function<void(std::size_t run, const std::string& row)> on_row;  // after each run that has ended
  std::function<bool()> stop_requested;                                 // asked often; once true, what runs is given up
};

/// Runs what has no row yet of `runs` (all where empty), `jobs` at a time, a thread each. The directory then has their
/// rows. FileError when a row cannot be written; nothing is lost then.
void run_study(const Study& study, StudyDirectory& directory, int jobs, const std::vector<std::size_t>& runs,
               const StudyHooks& hooks);

}  // namespace plica
