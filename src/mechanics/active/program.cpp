#include "mechanics/active/program.hpp"

#include <algorithm>

#include "core/clock.hpp"

namespace plica {

double Program::at(double time_s) const {
  if (times_.empty()) return 1;
  // The first point that has not passed: a step that ends on a jump, but for rounding, still has the activity before
  // it.
  const auto next = std::ranges::find_if(times_, [&](double point) { return point >= time_s - instant_s; });
  if (next == times_.begin()) return activities_.front();
  if (next == times_.end()) return activities_.back();
  const std::size_t i = next - times_.begin();
  if (time_s >= times_[i]) return activities_[i];
  const double part = (time_s - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return activities_[i - 1] + part * (activities_[i] - activities_[i - 1]);
}

std::vector<double> Program::jumps_s() const {
  std::vector<double> jumps;
  for (std::size_t i = 1; i < times_.size(); ++i)
    if (times_[i] == times_[i - 1]) jumps.push_back(times_[i]);
  return jumps;
}

}  // namespace plica
