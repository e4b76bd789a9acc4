// Table of walls: lateral faces by the cells that they separate.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// Lateral faces between two cells, or those by which a cell touches no other.
struct MeasuredWall {
  CellId cell;
  std::optional<CellId> other;  // of a higher index; none at a rim
  double length_um = 0;         // mean of base and apex
  double area_um2 = 0;
  double tension = 0;  // nN/um; of all lateral cortices, mean by area

  bool operator==(const MeasuredWall&) const = default;
};

/// Return the walls of the tissue, in order of `cell` and `other`, rims first.
std::vector<MeasuredWall> measured_walls(const Model& model, const State& state);

/// Return the factors on the tension of walls in a lateral cortex that were set from outside; walls in that order, 1
/// where there are none. UsageError for another law.
std::vector<double> wall_factors(const Model& model, const State& state, const std::string& label);

/// Return the internal state of a lateral cortex with these factors, likewise; empty: none. UsageError, with what would
/// be right, for another law, a wrong size or a value.
std::vector<double> with_wall_factors(const Model& model, const State& state, const std::string& label,
                                      std::span<const double> factors);

}  // namespace plica
