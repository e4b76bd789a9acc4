// What a study will take, before it is begun.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "study/study.hpp"

namespace plica {

struct StudyForecast {
  std::size_t runs = 0, points = 0;
  std::vector<std::string> refused;  // of points whose values are no valid scenario: point and reason
  std::size_t first_run = 0;         // the first that is none of these, which has been run
  RunRow first;
  double bytes_a_run = 0;  // on the disk
};

/// Looks at every point, and runs the first that is a scenario, in a directory of its own that goes again. `stop`: as
/// of Study::run; then `first` has no status.
StudyForecast forecast(const Study& study, const std::function<bool()>& stop);

}  // namespace plica
