// Activity of cells that follows a signal, of laws that remember no other activity of their own.
#pragma once

#include <algorithm>
#include <vector>

#include "mechanics/active/shape_activation.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Part of the internal state of a law: activities of all cells, from 0 to 1, in this step, then in the step before;
/// empty if they follow no signal.
class FollowedSignal {
 public:
  FollowedSignal() = default;
  FollowedSignal(const Tissue& tissue, const ShapeActivationRule& rule)
      : activation_(tissue, rule), cells_(tissue.cells.size()) {}
  /// Return the same for another tissue.
  [[nodiscard]] FollowedSignal on(const Tissue& tissue) const { return {tissue, activation_.rule()}; }

  [[nodiscard]] bool is_used() const { return activation_.is_used(); }
  /// Length of the part.
  [[nodiscard]] std::size_t size() const { return is_used() ? 2 * cells_ : 0; }

  [[nodiscard]] double at(std::span<const double> part, CellId cell) const {
    return is_used() ? part[cell.index()] : 1;
  }
  [[nodiscard]] double before(std::span<const double> part, CellId cell) const {
    return is_used() ? part[cells_ + cell.index()] : 1;
  }
  /// Return the mean of both, whose forces do the work of a step.
  [[nodiscard]] double mean(std::span<const double> part, CellId cell) const {
    return 0.5 * (before(part, cell) + at(part, cell));
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
  std::size_t cells_ = 0;
};

/// Law that remembers nothing else.
class SignalLaw : public Law {
 public:
  [[nodiscard]] std::vector<double> first_internal(const Tissue& /*tissue*/) const override {
    return std::vector<double>(followed_.size(), 0);
  }
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override {
    std::vector<double> internal(step.internal.begin(), step.internal.end());
    followed_.move_on(internal);
    return internal;
  }
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& /*tissue*/,
                                                          const TissueChange& change,
                                                          const ChangePositions& /*positions*/) const override {
    return followed_.after_change(internal, change);
  }
  [[nodiscard]] std::vector<double> with_signals(std::span<const double> internal, std::span<const CellArray> signals,
                                                 double time_s) const override {
    std::vector<double> result(internal.begin(), internal.end());
    followed_.follow(signals, time_s, result);
    return result;
  }

 protected:
  explicit SignalLaw(FollowedSignal followed) : followed_(std::move(followed)) {}

  FollowedSignal followed_;
};

}  // namespace plica
