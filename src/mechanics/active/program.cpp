#include "mechanics/active/program.hpp"

#include <algorithm>

#include "core/clock.hpp"

namespace plica {
namespace {

// Points shifted by every delay; delays closer than `apart` times the longest count as one.
std::vector<double> delayed(const std::vector<double>& points, std::vector<double> delays, double apart) {
  delays.push_back(0);
  std::ranges::sort(delays);
  std::vector<double> kept = {0};
  for (const double delay : delays)
    if (delay > kept.back() && (delay >= kept.back() + apart * delays.back() || delay == delays.back()))
      kept.push_back(delay);
  std::vector<double> shifted;
  for (const double point : points)
    for (const double delay : kept) shifted.push_back(point + delay);
  std::ranges::sort(shifted);
  shifted.erase(std::unique(shifted.begin(), shifted.end()), shifted.end());
  return shifted;
}

}  // namespace

double Program::at(double time_s) const {
  if (times_.empty()) return 1;
  // First point not yet passed: a step that ends on a jump, within rounding, still has the activity before it.
  const auto next = std::ranges::find_if(times_, [&](double point) { return point >= time_s - instant_s; });
  if (next == times_.begin()) return activities_.front();
  if (next == times_.end()) return activities_.back();
  const std::size_t i = next - times_.begin();
  if (time_s >= times_[i]) return activities_[i];
  const double part = (time_s - times_[i - 1]) / (times_[i] - times_[i - 1]);
  return activities_[i - 1] + part * (activities_[i] - activities_[i - 1]);
}

double Program::slope_at(double time_s) const {
  const auto next = std::ranges::upper_bound(times_, time_s);
  if (next == times_.begin() || next == times_.end()) return 0;
  const std::size_t i = next - times_.begin();
  return (activities_[i] - activities_[i - 1]) / (times_[i] - times_[i - 1]);
}

double Program::integral(double from_s, double to_s) const {
  if (times_.empty()) return to_s - from_s;
  const auto from_first_point = [&](double time_s) {
    if (time_s <= times_.front()) return activities_.front() * (time_s - times_.front());
    double sum = activities_.back() * std::max(0.0, time_s - times_.back());
    for (std::size_t i = 1; i < times_.size() && times_[i - 1] < time_s; ++i) {
      const double length = times_[i] - times_[i - 1], passed = std::min(length, time_s - times_[i - 1]);
      if (length > 0)
        sum += passed * (activities_[i - 1] + 0.5 * passed / length * (activities_[i] - activities_[i - 1]));
    }
    return sum;
  };
  return from_first_point(to_s) - from_first_point(from_s);
}

std::vector<double> Program::jumps_s() const {
  std::vector<double> jumps;
  for (std::size_t i = 1; i < times_.size(); ++i)
    if (times_[i] == times_[i - 1]) jumps.push_back(times_[i]);
  return jumps;
}

double Program::delayed_at(double delay_s, double time_s) const {
  const double own_time = time_s - delay_s;
  return own_time < -1e-9 ? 0 : at(own_time);  // a step may end on the delay only within rounding
}

std::vector<double> Program::delayed_points_s(std::vector<double> delays_s) const {
  const std::vector<double> from_start = {0};  // a program without points: from nothing to 1 at its time 0
  return delayed(times_.empty() ? from_start : times_, std::move(delays_s), jumps_s().empty() ? 0.01 : 0);
}

std::vector<double> Program::delayed_jumps_s(std::vector<double> delays_s) const {
  return delayed(jumps_s(), std::move(delays_s), 0);
}

}  // namespace plica
