// Activity over time: linear between points, held before the first and after the last.
#pragma once

#include <vector>

namespace plica {

class Program {
 public:
  Program() = default;  // always 1
  /// Times in s, strictly increasing, one activity each. Empty: always 1.
  Program(std::vector<double> times_s, std::vector<double> activities)
      : times_(std::move(times_s)), activities_(std::move(activities)) {}

  [[nodiscard]] double at(double time_s) const;
  /// The time of the last point, s: from then on the activity is constant.
  [[nodiscard]] double end_s() const { return times_.empty() ? 0 : times_.back(); }
  [[nodiscard]] const std::vector<double>& times_s() const { return times_; }

 private:
  std::vector<double> times_, activities_;
};

}  // namespace plica
