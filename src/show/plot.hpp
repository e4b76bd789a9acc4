// Line charts: axes with ticks and units, curves with colours and dashes, guides for reference values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "show/svg.hpp"

namespace plica {

struct PlotAxis {
  std::string label;  // with its unit
  bool logarithmic = false;
  std::optional<double> low = {}, high = {};  // empty: from the data
  bool whole = false;                         // ticks at integers only
};

struct Curve {
  std::string name;
  std::vector<double> x, y;  // of equal length; values not finite, or not > 0 on a logarithmic axis, are gaps
  bool marks = false;        // dots at points
  bool line = true;          // lines between points
};

/// Reference value, or with `high` a band, to compare with the curves. Bands may be infinite.
struct Guide {
  std::string label;
  double at = 0;
  std::optional<double> high = {};
};

struct Plot {
  std::string title;
  PlotAxis x, y;
  std::vector<Curve> curves;
  std::vector<Guide> vertical, horizontal;
};

/// Draw the chart, 680 x 400 pixels plus the legend below, in Okabe and Ito's colour-blind-safe colours.
Svg draw(const Plot& plot);

/// Table of the curves: curve, x, y.
std::string plot_csv(const Plot& plot);

/// Ticks from `low` to `high`: steps of 1, 2 or 5 times a power of ten, at least 1 if `whole`; on a logarithmic axis
/// powers of ten, with 2 and 5 times these if few.
std::vector<double> axis_ticks(double low, double high, bool logarithmic, bool whole = false);

}  // namespace plica
