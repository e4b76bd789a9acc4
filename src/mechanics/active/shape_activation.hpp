// Shape-dependent activity: a program that starts at a threshold of area, height, stretch or a signal, of the cell
// itself or of its neighbours, or an activity that follows it (docs/theory/cortex.md, "Time-prescribed and
// shape-dependent activity").
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

struct BeginningGradient;
struct Step;

/// Quantity of a cell relative to its reference value, or its passive stress (mechanics/cell_stress.hpp). The stretch
/// is that of its apical surface along the direction of largest stretch.
enum class ShapeMeasure { apical_area_ratio, basal_area_ratio, height_ratio, apical_stretch, passive_stress };

/// Names in scenarios and reactions of those of shape, in order.
inline constexpr std::array<std::string_view, 4> shape_measure_names = {"apical_area_ratio", "basal_area_ratio",
                                                                        "height_ratio", "apical_stretch"};

/// Rule by which cells start, or follow a shape or a signal. Cell numbers are those at the beginning of a step.
struct ShapeActivationRule {
  enum class Kind { none, starts_below, starts_above, follows };
  Kind kind = Kind::none;
  ShapeMeasure measure = ShapeMeasure::apical_area_ratio;
  double threshold = 1;     // for both triggers
  double from = 1, to = 0;  // follow: activity 0 up to `from`, 1 beyond `to`, linear between
  // Place among the model's signals, which replaces the measure; after the last: the stress (follow_signals).
  std::optional<std::size_t> signal = {};
  bool of_neighbours = false;  // their mean, instead of the cell's own value
  // Triggers: start at the crossing of the threshold, interpolated linearly within the step, not at the end of the
  // step.
  bool at_crossing = false;
};

/// Return the weights of corners by which values sum to the mean over their polygon of the gradient of a field (by
/// Gauss' theorem; in the plane that the polygon lies closest to).
std::vector<Eigen::RowVector2d> mean_gradient(std::span<const Vec3> polygon);

/// State, one number per cell: start time (s) or `not_yet` for cells with a trigger, or progress from 0 to 1 for cells
/// that follow.
class ShapeActivation {
 public:
  static constexpr double not_yet = -1;

  ShapeActivation() = default;
  ShapeActivation(const Tissue& tissue, const ShapeActivationRule& rule);

  [[nodiscard]] const ShapeActivationRule& rule() const { return rule_; }
  [[nodiscard]] bool is_used() const { return rule_.kind != ShapeActivationRule::Kind::none; }
  /// Use the rule at_crossing.
  void start_at_crossing() { rule_.at_crossing = true; }
  [[nodiscard]] bool starts() const { return is_used() && rule_.kind != ShapeActivationRule::Kind::follows; }

  /// Return the state at given positions and time from the previous state (empty before the first step).
  [[nodiscard]] std::vector<double> internal(std::span<const Vec3> positions, double time_s,
                                             std::span<const double> before) const;
  /// Return it from the signals of a state (cells, by signal) if the rule reads one; otherwise `before`.
  [[nodiscard]] std::vector<double> of_signals(std::span<const CellArray> signals, double time_s,
                                               std::span<const double> before) const;

  /// Return the state at the end of a step.
  [[nodiscard]] std::vector<double> after(const Step& step, std::span<const double> before) const;
  /// Return it for the cells that start in this step in `next`, another state at its end, of a rule at_crossing.
  [[nodiscard]] std::vector<double> after_like(const Step& step, std::span<const double> before,
                                               std::span<const double> next) const;
  /// Add the gradient of adjoint . after_like by positions at the end of the step and by what it begins with.
  void add_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                    std::span<Vec3> positions, const BeginningGradient& gradient) const;
  /// Move the gradient by states of cells that follow a signal to that by the signal; others stay.
  void move_to_signals(std::span<double> by_state, std::span<const CellArray> signals,
                       std::span<CellArray> by_signals) const;

  /// Return the quantity of each cell itself.
  [[nodiscard]] std::vector<double> ratios(std::span<const Vec3> positions) const;
  /// Add the gradient of sum weights . ratios; cells.
  void add_ratio_gradient(std::span<const Vec3> positions, std::span<const double> weights,
                          std::span<Vec3> gradient) const;

 private:
  [[nodiscard]] double progress(double ratio) const { return (ratio - rule_.from) / (rule_.to - rule_.from); }
  [[nodiscard]] Eigen::Matrix<double, 3, 2> apical_stretch(std::size_t cell, std::span<const Vec3> positions) const;
  [[nodiscard]] std::vector<double> next(std::vector<double> values, double time_s,
                                         std::span<const double> before) const;
  [[nodiscard]] std::vector<double> sizes(std::span<const Vec3> positions) const;
  /// Return what cells read, given the value of each; and the gradient by values from that by what is read.
  [[nodiscard]] std::vector<double> read(std::vector<double> values) const;
  [[nodiscard]] std::vector<double> by_values(std::vector<double> by_read) const;

  ShapeActivationRule rule_;
  std::vector<Facet> facets_;                               // areas: facets of that side
  std::vector<std::vector<std::array<NodeId, 2>>> edges_;   // heights: of each cell, basal to apical
  std::vector<std::vector<NodeId>> apices_;                 // stretches: apical corners of each cell
  std::vector<std::vector<Eigen::RowVector2d>> gradients_;  // stretches: their weights for the mean gradient
  std::vector<double> at_rest_;                             // cells; 1 for stretches
  std::vector<std::vector<CellId>> neighbours_;             // of each cell; empty: it reads itself
};

}  // namespace plica
