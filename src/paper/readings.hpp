// Table of readings that the paper's text allows, and their score against all printed numbers.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paper/measures.hpp"

namespace plica {

struct ReadingOptions {
  std::string base = "drosophila";
  bool scanned = false;           // claims that hold in all scanned readings need no choice
  bool depth_below_lips = false;  // "total depth" is measured from the lips
  int vce = 2;                    // position of VCE from the end
  std::string same_runs_as = {};  // reading whose runs are reused with other measures
  bool quick = false;             // part of --quick
};

/// Reading of the paper: scenario `drosophila` with some keys changed, on pill and sphere.
struct PaperReading {
  std::string id;                      // name of its runs
  std::string group;                   // varied property
  std::string text;                    // the choice
  std::vector<std::string> overrides;  // KEY=VALUE, of both embryos
  ReadingOptions options = {};
};

std::span<const PaperReading> readings();

/// Overrides that turn a pill scenario into the sphere with the same cells.
std::vector<std::string> sphere_overrides(const PaperReading& reading);

/// Printed number, met within centre +- half.
struct PrintedNumber {
  std::string name;  // of the figure, with prefix "pill." or "sphere."
  std::string text;
  double centre = 0, half = 1;
};

std::span<const PrintedNumber> printed_numbers();

struct Score {
  double rms = 0;  // of the misses |value - centre| / half, each at most `largest_miss`, also for missing values
  int met = 0;     // misses up to 1
};

inline constexpr double largest_miss = 5;

/// Score a reading. `figures`: prefixed figures of its two runs. Empty if an embryo has none.
std::optional<Score> score(const PaperReading& reading, const Figures& figures);

/// Figure by name; empty if missing.
std::optional<double> figure_named(const Figures& figures, const std::string& name);

/// Figure for a printed number, with depth and VCE as defined by the reading.
std::optional<double> figure_in(const PaperReading& reading, const std::string& name, const Figures& figures);

}  // namespace plica
