// What cells are told from outside to do, in place of their programs (Simulation::set_activity): by light, or by a rule
// that somebody else computes. A number a cell at the end of a law's internal state, so that checkpoints, copies and
// daughters have it, too.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tissue/division.hpp"

namespace plica {

class GivenActivities {
 public:
  /// In place of a cell's activity: it follows its program.
  static constexpr double as_programmed = -1;

  /// Those in an internal state, after the `own` numbers that the law itself remembers; none where nobody has given
  /// any.
  GivenActivities(std::span<const double> internal, std::size_t own)
      : given_(internal.size() > own ? internal.subspan(own) : std::span<const double>()) {}

  /// Nothing where the cell follows its program.
  [[nodiscard]] std::optional<double> of(CellId cell) const {
    if (cell.index() >= given_.size() || given_[cell.index()] == as_programmed) return std::nullopt;
    return given_[cell.index()];
  }

  [[nodiscard]] std::span<const double> numbers() const { return given_; }
  /// Daughters do what their mother did.
  [[nodiscard]] std::vector<double> after_division(const Division& division) const {
    return given_.empty() ? std::vector<double>() : inherited(division, std::vector(given_.begin(), given_.end()));
  }

  /// An internal state with these, or without any.
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
