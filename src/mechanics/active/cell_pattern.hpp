// Who acts, how strongly and how late: region, profile over it, chance, and a wave, for every law by which cells act
// (docs/theory/contraction.md, "From cell to cell").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "tissue/division.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Along the embryo's axis: x. Across it: the arc about the axis through the cell's centre, from the region's mean
/// direction, to the right (+y) on the belly; y in a tissue that has no outer shape.
enum class PatternAxis { along, across };

/// How near the middle a cell is, by the distance d from there along an axis: 1 at the middle.
struct StrengthProfile {
  enum class Shape { constant, linear, gaussian, plateau };
  Shape shape = Shape::constant;
  PatternAxis axis = PatternAxis::across;
  double half_width = 1;  // um; linear: 0 there and beyond. Plateau: 1 up to there
  double sigma = 1;       // um; gaussian: exp(-d^2 / (2 sigma^2))
  double fade = 0;        // um; plateau: then a cosine that is 0 after this length
  bool in_cells = false;  // these lengths are in mean widths of the cells, along that axis

  [[nodiscard]] double nearness(double distance) const;
};

/// The same along the embryo besides: 1 up to half of `full_length`, then a cosine that is 0 after another `fade`.
struct Taper {
  double full_length = 0;  // um
  double fade = 0;         // um; 0: no taper

  [[nodiscard]] double nearness(double distance) const;
};

/// A wave that starts at a place of the region at time 0 and reaches a cell after distance / speed.
struct StartDelay {
  enum class From { middle, ends, low, high };  // low: the region's least coordinate; ends: both, whichever is nearer
  PatternAxis axis = PatternAxis::along;
  From from = From::middle;
  double speed = 0;  // um/s; 0: no wave, all cells at once
};

struct PatternRule {
  StrengthProfile profile;
  Taper taper;
  double middle = 1, edge = 0;   // the factor where both are 1, and where one is 0; linear between
  std::optional<CellSet> about;  // whose middle, and widths of cells, these are; without it those of the cells that act
  StartDelay delay;
  double spread = 0;       // standard deviation of the cells' chance factors, whose mean is 1
  std::uint64_t seed = 1;  // of these factors
};

/// What a law by which cells act is told of each cell.
struct CellPattern {
  CellSet cells;                  // who acts; empty: nobody
  std::vector<double> strengths;  // cells; a factor, 0 of those that do not act
  std::vector<double> delays_s;   // cells

  CellPattern() = default;
  /// All alike, and at once.
  CellPattern(const CellSet& who);  // NOLINT: meant to convert

  /// Daughters have what their mother had.
  [[nodiscard]] CellPattern after_division(const Division& division) const;
};

/// The pattern of `cells` on `tissue` at rest; 0 in both for other cells. A region's middle lies halfway between its
/// outermost cell centres.
CellPattern cell_pattern(const Tissue& tissue, const CellSet& cells, const PatternRule& pattern);

/// A log-normal factor with mean 1 and standard deviation `spread`: a function of seed and cell only, the same on every
/// machine but for the last bit of its exp, log and cos.
double chance_factor(double spread, std::uint64_t seed, std::size_t cell);

}  // namespace plica
