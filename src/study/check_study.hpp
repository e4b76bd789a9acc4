// Estimate of the cost of a study before it starts.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace plica {

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
