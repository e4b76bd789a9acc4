// Activity over time: linear between points, held before the first and after the last. Two points of one time are a
// jump: until that time and at it the activity is the first's, later the second's.
#pragma once

#include <vector>

namespace plica {

class Program {
 public:
  Program() = default;  // always 1
  /// Times in s, increasing, one activity each. Empty: always 1.
  Program(std::vector<double> times_s, std::vector<double> activities)
      : times_(std::move(times_s)), activities_(std::move(activities)) {}

  [[nodiscard]] double at(double time_s) const;
  /// Of what follows the program `delay_s` later: 0 before the program's time 0.
  [[nodiscard]] double delayed_at(double delay_s, double time_s) const;
  /// The time of the last point, s: from then on the activity is constant.
  [[nodiscard]] double end_s() const { return times_.empty() ? 0 : times_.back(); }
  [[nodiscard]] const std::vector<double>& times_s() const { return times_; }
  /// Times at which it jumps.
  [[nodiscard]] std::vector<double> jumps_s() const;

  /// Increasing: its points shifted by each of the delays and by none. Of a program without jumps, delays closer than a
  /// hundredth of the longest count as one.
  [[nodiscard]] std::vector<double> delayed_points_s(std::vector<double> delays_s) const;
  /// And its jumps, shifted by every delay.
  [[nodiscard]] std::vector<double> delayed_jumps_s(std::vector<double> delays_s) const;

 private:
  std::vector<double> times_, activities_;
};

}  // namespace plica
