// The readings that the paper's text leaves open, as a table, and the score that all its printed numbers give each.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "paper/measures.hpp"

namespace plica {

struct ReadingOptions {
  std::string base = "drosophila";
  bool scanned = false;           // a claim that holds in all of these needs no choice
  bool depth_below_lips = false;  // "total depth" means from the lips down
  int vce = 2;                    // which cell from the end VCE is
  std::string same_runs_as = {};  // measured otherwise, in the runs of that reading
  bool quick = false;             // a part of --quick
};

/// One way to read the paper: the scenario `drosophila` with some keys changed, on the pill and on the sphere.
struct PaperReading {
  std::string id;                      // names its runs
  std::string group;                   // what is varied
  std::string text;                    // the choice
  std::vector<std::string> overrides;  // KEY=VALUE, of both embryos
  ReadingOptions options = {};
};

std::span<const PaperReading> readings();

/// The keys that turn a pill scenario into the sphere with the same cells.
std::vector<std::string> sphere_overrides(const PaperReading& reading);

/// A printed number: what is within centre +- half counts as met.
struct PrintedNumber {
  std::string name;  // of the figure, with "pill." or "sphere." before it
  std::string text;
  double centre = 0, half = 1;
};

std::span<const PrintedNumber> printed_numbers();

struct Score {
  double rms = 0;  // of the misses |value - centre| / half, each at most `largest_miss`; a missing value counts as that
  int met = 0;     // misses up to 1
};

inline constexpr double largest_miss = 5;

/// `figures`: of the reading's two runs, prefixed. Nothing where there is no figure of one of the embryos.
std::optional<Score> score(const PaperReading& reading, const Figures& figures);

/// The figure of that name, where there is one.
std::optional<double> figure_named(const Figures& figures, const std::string& name);

/// The figure that a printed number has in a reading: depth and VCE as the reading takes them.
std::optional<double> figure_in(const PaperReading& reading, const std::string& name, const Figures& figures);

}  // namespace plica
