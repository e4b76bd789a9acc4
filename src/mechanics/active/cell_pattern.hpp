// Who acts, how strongly and how late: region, profile over it, chance, and a wave, for every law by which cells act
// (docs/theory/contraction.md, "From cell to cell").
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/vector.hpp"
#include "mechanics/active/program.hpp"
#include "tissue/division.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Along the embryo's axis: x. Across it: the arc about the axis through the cell's centre, from the region's mean
/// direction, to the right (+y) on the belly; y in a tissue that has no outer shape. Angle: about the axis, in degrees,
/// 0 at the belly, to the right.
enum class PatternAxis { along, across, angle };

/// How near the middle a cell is, by its place along an axis, d from there: 1 at the middle. Or by what was measured.
struct StrengthProfile {
  enum class Shape { constant, linear, gaussian, plateau, table, array };
  Shape shape = Shape::constant;
  PatternAxis axis = PatternAxis::across;
  double centre = 0;      // of an axis of angles: where the middle is
  double half_width = 1;  // um or degrees; linear: 0 there and beyond. Plateau: 1 up to there
  double sigma = 1;       // gaussian: exp(-d^2 / (2 sigma^2))
  double fade = 0;        // plateau: then a cosine that is 0 after this length
  // Table: linear between these points, as at the ends beyond them. Places are distances, on both sides alike, where
  // none is negative.
  std::vector<double> places = {}, values = {};
  bool in_cells = false;            // these lengths are in mean widths of the cells, along that axis
  CellArray array = {};             // array: of all cells
  double array_0 = 0, array_1 = 1;  // its values for 0 and for 1; beyond them as there

  [[nodiscard]] double nearness(double place) const;
  [[nodiscard]] double of_array(double value) const;
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

/// Activity that swells and ebbs as a sine, with a period and a phase for each cell.
struct PulseRule {
  double period_s = 0;    // mean of the cells' periods; 0: no pulses
  double amplitude = 1;   // the factor goes from 1 - amplitude to 1 + amplitude
  bool together = false;  // all in phase
  double spread = 0;      // relative standard deviation of the periods
  std::uint64_t seed = 1;
};

struct PatternRule {
  StrengthProfile profile;
  Taper taper;
  double middle = 1, edge = 0;   // the factor where both are 1, and where one is 0; linear between
  std::optional<CellSet> about;  // whose middle, and widths of cells, these are; without it those of the cells that act
  StartDelay delay;
  double spread = 0;       // standard deviation of the cells' chance factors, whose mean is 1
  std::uint64_t seed = 1;  // of these factors
  bool by_place = false;   // a cell's factor goes with where it lies at rest, not with its number
  PulseRule pulse;
};

/// Cells whose strength is taken away, for good or for a while.
struct Ablation {
  CellSet cells;
  Program remaining;  // the part of it that is left

  /// All of it until a time and at it, later `part`, until another time or for ever.
  Ablation(CellSet who, double part, double at_s, std::optional<double> until_s);
};

/// What a law by which cells act is told of each cell.
struct CellPattern {
  CellSet cells;                  // who acts; empty: nobody
  std::vector<double> strengths;  // cells; a factor, 0 of those that do not act
  std::vector<double> delays_s;   // cells
  double pulse_amplitude = 0;
  std::vector<double> pulse_periods_s, pulse_phases;  // cells, phases in periods; empty: no pulses
  std::vector<Ablation> ablations;                    // one that comes upon another takes a part of what that has left

  CellPattern() = default;
  /// All alike, and at once.
  CellPattern(const CellSet& who);  // NOLINT: meant to convert

  /// The factor that pulses put on a cell's activity, whose mean over a period is 1.
  [[nodiscard]] double pulse(CellId cell, double time_s) const;

  /// The part of a cell's strength that ablations have left.
  [[nodiscard]] double remaining(CellId cell, double time_s) const;
  /// These times, and those at which ablations begin and end, where forces jump; in order.
  [[nodiscard]] std::vector<double> with_ablations(std::vector<double> times_s) const;

  /// Daughters have what their mother had.
  [[nodiscard]] CellPattern after_division(const Division& division) const;
};

/// The pattern of `cells` on `tissue` at rest; 0 in both for other cells. A region's middle lies halfway between its
/// outermost cell centres.
CellPattern cell_pattern(const Tissue& tissue, const CellSet& cells, const PatternRule& pattern);

/// A log-normal factor with mean 1 and standard deviation `spread`: a function of seed and cell only, the same on every
/// machine but for the last bit of its exp, log and cos.
double chance_factor(double spread, std::uint64_t seed, std::uint64_t cell);

/// A number for the place of a cell, by which chance can go, so that it does not matter how cells are numbered: the
/// same for places that differ by rounding.
std::uint64_t place_number(const Vec3& place);

}  // namespace plica
