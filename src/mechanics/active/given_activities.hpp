// Per-cell activities set from outside (Simulation::set_activity), which override programs, e.g. for light or feedback.
// One number per cell at the end of the internal state of a law, so checkpoints, copies and daughters keep them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tissue/division.hpp"

namespace plica {

class GivenActivities {
 public:
  /// Mark a cell that follows its program.
  static constexpr double as_programmed = -1;

  /// Return the activities in an internal state, after `own` numbers of the law itself; empty if none are set.
  GivenActivities(std::span<const double> internal, std::size_t own)
      : given_(internal.size() > own ? internal.subspan(own) : std::span<const double>()) {}

  /// Return the activity of a cell; empty if it follows its program.
  [[nodiscard]] std::optional<double> of(CellId cell) const {
    if (cell.index() >= given_.size() || given_[cell.index()] == as_programmed) return std::nullopt;
    return given_[cell.index()];
  }

  [[nodiscard]] std::span<const double> numbers() const { return given_; }
  /// Return activities after a division; daughters inherit from the mother cell.
  [[nodiscard]] std::vector<double> after_division(const Division& division) const {
    return given_.empty() ? std::vector<double>() : inherited(division, std::vector(given_.begin(), given_.end()));
  }

  /// Return an internal state with these activities, or without any.
  [[nodiscard]] static std::vector<double> put(std::span<const double> internal, std::size_t own,
                                               std::span<const double> activities) {
    std::vector<double> result(internal.begin(), internal.begin() + static_cast<std::ptrdiff_t>(own));
    result.insert(result.end(), activities.begin(), activities.end());
    return result;
  }

 private:
  std::span<const double> given_;
};

}  // namespace plica
