// Activity time course: linear between points, constant before the first and after the last. Two points at one time
// mark a jump: up to and at that time the first value holds, later the second.
#pragma once

#include <vector>

namespace plica {

class Program {
 public:
  Program() = default;  // always 1
  /// Make a program from increasing times in s with one activity each; empty: always 1.
  Program(std::vector<double> times_s, std::vector<double> activities)
      : times_(std::move(times_s)), activities_(std::move(activities)) {}

  [[nodiscard]] double at(double time_s) const;
  /// Return the slope of the activity, 1/s; between points.
  [[nodiscard]] double slope_at(double time_s) const;
  /// Return the activity with a delay of `delay_s`; 0 before time 0 of the program.
  [[nodiscard]] double delayed_at(double delay_s, double time_s) const;
  /// Return the integral of the activity over a time, s.
  [[nodiscard]] double integral(double from_s, double to_s) const;
  [[nodiscard]] const std::vector<double>& times_s() const { return times_; }
  [[nodiscard]] std::vector<double> jumps_s() const;

  /// Return increasing times of its points, shifted by each delay and by none. For a program without jumps, delays
  /// closer than 1 % of the longest count as one.
  [[nodiscard]] std::vector<double> delayed_points_s(std::vector<double> delays_s) const;
  /// Return its jumps, shifted by every delay.
  [[nodiscard]] std::vector<double> delayed_jumps_s(std::vector<double> delays_s) const;

 private:
  std::vector<double> times_, activities_;
};

}  // namespace plica
