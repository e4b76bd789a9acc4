#include "mechanics/active/program.hpp"

#include <algorithm>

namespace plica {

double Program::at(double time_s) const {
  if (times_.empty()) return 1;
  const auto after = std::upper_bound(times_.begin(), times_.end(), time_s);
  if (after == times_.begin()) return activities_.front();
  if (after == times_.end()) return activities_.back();
  const std::size_t i = after - times_.begin();
  const double part = (time_s - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return activities_[i - 1] + part * (activities_[i] - activities_[i - 1]);
}

}  // namespace plica
