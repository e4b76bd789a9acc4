// Activity of cells that follows a signal, of laws that remember no other activity of their own.
#pragma once

#include <algorithm>
#include <vector>

#include "mechanics/active/shape_activation.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Part of the internal state of a law: activities of all cells, from 0 to 1, in this step, then in the step before;
/// empty if they follow no signal.
class FollowedSignal {
 public:
  FollowedSignal(const Tissue& tissue, const ShapeActivationRule& rule)
      : activation_(tissue, rule), cells_(tissue.cells.size()) {}

  [[nodiscard]] bool is_used() const { return activation_.is_used(); }
  /// Length of the part.
  [[nodiscard]] std::size_t size() const { return is_used() ? 2 * cells_ : 0; }

  [[nodiscard]] double at(std::span<const double> part, CellId cell) const {
    return is_used() ? part[cell.index()] : 1;
  }
  [[nodiscard]] double before(std::span<const double> part, CellId cell) const {
    return is_used() ? part[cells_ + cell.index()] : 1;
  }

  /// Move on by a step, before the signals are known at its end.
  void move_on(std::span<double> part) const {
    std::copy_n(part.begin(), part.size() / 2, part.begin() + part.size() / 2);
  }
  /// Follow the signals of a state (cells, by signal) at its time.
  void follow(std::span<const CellArray> signals, double time_s, std::span<double> part) const {
    if (!is_used()) return;
    std::ranges::copy(activation_.of_signals(signals, time_s, {}), part.begin());
    if (time_s == 0) move_on(part);
  }
  /// Return the part after a change of the tissue; called before it.
  [[nodiscard]] std::vector<double> after_change(std::span<const double> part, const TissueChange& change) const {
    std::vector<double> after;
    for (std::size_t first = 0; first < part.size(); first += cells_)
      for (const CellId origin : change.origin) after.push_back(part[first + origin.index()]);
    return after;
  }

 private:
  ShapeActivation activation_;
  std::size_t cells_;
};

}  // namespace plica
