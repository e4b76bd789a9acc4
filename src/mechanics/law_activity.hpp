// How a law acts: by programs, by cells, by signals. By default it does not.
#pragma once

#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include "core/ids.hpp"

namespace plica {

struct CellPattern;
template <class Value>
struct ByCell;
using CellArray = ByCell<double>;

class LawActivity {
 public:
  /// Return times at which its programs begin or bend, s; steps end on them.
  [[nodiscard]] virtual std::vector<double> program_points_s() const { return {}; }
  /// Return times at which forces jump, s; past motion does not predict motion after them.
  [[nodiscard]] virtual std::vector<double> program_jumps_s() const { return {}; }

  /// Whether this law is active: its forces are shown as active forces. activity_of returns the activity of a cell at a
  /// time, by program or internal state; empty for other cells.
  [[nodiscard]] virtual bool is_active() const { return false; }
  [[nodiscard]] virtual std::optional<double> activity_of(CellId /*cell*/, double /*time_s*/,
                                                          std::span<const double> /*internal*/) const {
    return {};
  }

  /// Return the internal state with activities set from outside instead of by programs (GivenActivities).
  /// std::logic_error for laws that are not active.
  [[nodiscard]] virtual std::vector<double> with_activities(std::span<const double> /*internal*/,
                                                            std::span<const double> /*activities*/) const {
    throw std::logic_error("this law is not active");
  }

  /// Return the internal state with activities that follow the signals of a state (cells, by signal) at its time.
  [[nodiscard]] virtual std::vector<double> with_signals(std::span<const double> internal,
                                                         std::span<const CellArray> /*signals*/,
                                                         double /*time_s*/) const {
    return {internal.begin(), internal.end()};
  }

  /// Return region, amplitudes and ablations of a law that acts by cells; null for others.
  [[nodiscard]] virtual const CellPattern* pattern() const { return nullptr; }

 protected:
  ~LawActivity() = default;
};

}  // namespace plica
