// Per-cell activation: region, spatial profile, random variation and activation wave, for every active law
// (docs/theory/contraction.md, "From cell to cell").
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "core/vector.hpp"
#include "mechanics/active/program.hpp"
#include "tissue/tissue.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Axis of a profile. along: the axis of the embryo, x. across: arc length about the axis through the cell centre, from
/// the mean direction of the region to the right (+y) on the ventral side; y in an open tissue (goes_round). angle:
/// about the axis, in degrees, 0 ventral, to the right.
enum class PatternAxis { along, across, angle };

/// Spatial profile: nearness of a cell to the middle (1 at the middle), from its distance d along an axis or from a
/// measured array.
struct StrengthProfile {
  enum class Shape { constant, linear, gaussian, plateau, table, array };
  Shape shape = Shape::constant;
  PatternAxis axis = PatternAxis::across;
  double centre = 0;      // middle, for an axis of angles
  double half_width = 1;  // um or degrees; linear: 0 from there on. Plateau: 1 up to there
  double sigma = 1;       // gaussian: exp(-d^2 / (2 sigma^2))
  double fade = 0;        // plateau: length of the cosine taper to 0
  // Table: linear between these points, constant beyond them. If no place is negative, places are distances on both
  // sides.
  std::vector<double> places = {}, values = {};
  bool in_cells = false;            // lengths are in mean cell widths along that axis
  CellArray array = {};             // array: values of all cells
  double array_0 = 0, array_1 = 1;  // its values for 0 and for 1; constant beyond them

  [[nodiscard]] double nearness(double place) const;
  [[nodiscard]] double of_array(double value) const;
};

/// Taper along the embryo: 1 up to half of `full_length`, then a cosine that reaches 0 after another `fade`.
struct Taper {
  double full_length = 0;  // um
  double fade = 0;         // um; 0: no taper

  [[nodiscard]] double nearness(double distance) const;
};

/// Activation wave: starts at a place of the region at time 0 and reaches a cell after distance / speed.
struct StartDelay {
  enum class From { middle, ends, low, high };  // low: least coordinate of the region; ends: the nearer of both
  PatternAxis axis = PatternAxis::along;
  From from = From::middle;
  double speed = 0;  // um/s; 0: no wave, all cells at once
};

/// Pulsed activity: a sine with a period and a phase for each cell.
struct PulseRule {
  double period_s = 0;    // mean period of the cells; 0: no pulses
  double amplitude = 1;   // factor between 1 - amplitude and 1 + amplitude
  bool together = false;  // all in phase
  double spread = 0;      // relative standard deviation of the periods
  std::uint64_t seed = 1;
};

struct PatternRule {
  StrengthProfile profile;
  Taper taper;
  double middle = 1, edge = 0;   // factor where both are 1, and where one is 0; linear between
  std::optional<CellSet> about;  // cells that define middle and cell widths; default: the active cells
  StartDelay delay;
  double spread = 0;       // standard deviation of random factors with mean 1
  std::uint64_t seed = 1;  // seed of these factors
  bool by_place = false;   // factors depend on reference position, not on cell number
  PulseRule pulse;
};

/// Laser ablation: loss of strength of some cells, permanently or for a time, at whose end it recovers.
struct Ablation {
  CellSet cells;
  Program remaining;                                         // remaining fraction
  std::optional<std::array<double, 2>> height_percent = {};  // only faces with their centres between; empty: all

  /// Ablation that leaves `part` of the strength after `at_s`, until `until_s` if given; all is back `recovery_s`
  /// later.
  Ablation(CellSet who, double part, double at_s, std::optional<double> until_s, double recovery_s = 0);

  static auto parts_by_cell(auto& ablation) { return std::tie(ablation.cells); }
};

/// Per-cell parameters of an active law.
struct CellPattern {
  CellSet cells;        // active cells; empty: none
  CellArray strengths;  // factor, 0 for inactive cells
  CellArray delays_s;
  double pulse_amplitude = 0;
  CellArray pulse_periods_s, pulse_phases;  // phases in periods; empty: no pulses
  std::vector<Ablation> ablations;          // a later one acts on what an earlier one has left

  CellPattern() = default;
  /// Make a pattern with equal strength and no delay.
  CellPattern(const CellSet& who);  // NOLINT: meant to convert

  /// Return the pulse factor on the activity of a cell; its mean over a period is 1.
  [[nodiscard]] double pulse(CellId cell, double time_s) const;

  /// Return the fraction of the strength of a cell that ablations have left, or of a face at this height; empty:
  /// without ablations at a height.
  [[nodiscard]] double remaining(CellId cell, double time_s, std::optional<double> height_percent = {}) const;
  /// Return these times and those of points or jumps of ablations, in order.
  [[nodiscard]] std::vector<double> with_ablation_points(std::vector<double> times_s) const;
  [[nodiscard]] std::vector<double> with_ablation_jumps(std::vector<double> times_s) const;

  /// Return the pattern after a division; daughters inherit from the mother cell.
  [[nodiscard]] CellPattern after_change(const TissueChange& change) const;

  static auto parts_by_cell(auto& pattern) {
    return std::tie(pattern.cells, pattern.strengths, pattern.delays_s, pattern.pulse_periods_s, pattern.pulse_phases,
                    pattern.ablations);
  }
};

/// Make the pattern of `cells` on `tissue` in the reference state; strength and delay of other cells are 0. The middle
/// of a region lies halfway between its outermost cell centres.
CellPattern cell_pattern(const Tissue& tissue, const CellSet& cells, const PatternRule& pattern);

/// Return a log-normal factor with mean 1 and standard deviation `spread`, a function of seed and cell only; identical
/// on all machines except for rounding in exp, log and cos.
double chance_factor(double spread, std::uint64_t seed, std::uint64_t cell);

/// Return a standard normal deviate, a function of both numbers only, likewise.
double normal_deviate(std::uint64_t seed, std::uint64_t number);

/// Return a well mixed number for two.
std::uint64_t pair_number(int one, int other);

/// Return a number for the place of a cell, as a random seed independent of cell numbering; equal for places that
/// differ by rounding.
std::uint64_t place_number(const Vec3& place);

/// Per-cell activities set from outside (Simulation::set_activity), which override programs, e.g. for light or
/// feedback. One number per cell at the end of the internal state of a law, so checkpoints, copies and daughters keep
/// them.
class GivenActivities {
 public:
  /// Mark a cell that follows its program.
  static constexpr double as_programmed = -1;

  /// View the end of an internal state; empty if none are set.
  explicit GivenActivities(std::span<const double> given) : given_(given) {}

  /// Return the activity of a cell; empty if it follows its program.
  [[nodiscard]] std::optional<double> of(CellId cell) const {
    if (cell.index() >= given_.size() || given_[cell.index()] == as_programmed) return std::nullopt;
    return given_[cell.index()];
  }

  [[nodiscard]] std::span<const double> internal() const { return given_; }
  /// Return activities after a division; daughters inherit from the mother cell.
  [[nodiscard]] std::vector<double> after_change(const TissueChange& change) const {
    return given_.empty() ? std::vector<double>() : inherited(change, std::vector(given_.begin(), given_.end()));
  }

  /// Return the internal state of which these are the end, with other activities or without any.
  [[nodiscard]] std::vector<double> put(std::span<const double> internal, std::span<const double> activities) const {
    std::vector<double> result(internal.begin(), internal.end() - static_cast<std::ptrdiff_t>(given_.size()));
    result.insert(result.end(), activities.begin(), activities.end());
    return result;
  }

 private:
  std::span<const double> given_;
};

}  // namespace plica
