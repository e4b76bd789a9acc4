// What a cell does by its own state, not at prescribed times: a program that starts when the cell has become so small,
// tall or flat, or an activity that follows it (docs/theory/cortex.md, "Time-prescribed and shape-dependent activity").
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Of a cell, over the same at rest. The stretch is that of its apex, along the direction in which it is largest.
enum class OwnMeasure { apical_area_ratio, basal_area_ratio, height_ratio, apical_stretch };

/// How cells begin, or go along. Numbers of cells are those at the beginning of a step.
struct OwnStateRule {
  enum class Kind { none, starts_below, starts_above, follows };
  Kind kind = Kind::none;
  OwnMeasure measure = OwnMeasure::apical_area_ratio;
  double threshold = 1;     // of the two that start
  double from = 1, to = 0;  // follows: the activity is 0 there and before, 1 there and beyond, linear between
};

/// One number a cell: of those that start, when it did (s), or `not_yet`; of one that follows, how far it has gone,
/// 0 to 1.
class OwnState {
 public:
  static constexpr double not_yet = -1;

  OwnState(const Tissue& tissue, const OwnStateRule& rule);

  [[nodiscard]] bool is_used() const { return rule_.kind != OwnStateRule::Kind::none; }
  [[nodiscard]] bool starts() const { return is_used() && rule_.kind != OwnStateRule::Kind::follows; }

  /// The numbers of cells at positions and a time, from those before; none before the first step.
  [[nodiscard]] std::vector<double> numbers(std::span<const Vec3> positions, double time_s,
                                            std::span<const double> before) const;

  /// The measure itself; cells.
  [[nodiscard]] std::vector<double> ratios(std::span<const Vec3> positions) const;

 private:
  [[nodiscard]] std::vector<double> sizes(std::span<const Vec3> positions) const;

  OwnStateRule rule_;
  std::vector<Facet> facets_;                               // areas: those of the measure's side
  std::vector<std::vector<std::array<NodeId, 2>>> edges_;   // heights: of each cell, from base to apex
  std::vector<std::vector<NodeId>> apices_;                 // stretches: corners of each cell's apex
  std::vector<std::vector<Eigen::RowVector2d>> gradients_;  // stretches: weights of these, for the mean gradient
  std::vector<double> at_rest_;                             // cells; of stretches, 1
};

}  // namespace plica
