// Line charts: axes with ticks and units, curves that differ in colour and in dashes, guides for printed values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "show/svg.hpp"

namespace plica {

struct PlotAxis {
  std::string label;  // with its unit
  bool logarithmic = false;
  std::optional<double> low = {}, high = {};  // empty: of the data
  bool whole = false;                         // ticks at whole numbers only
};

struct Curve {
  std::string name;
  std::vector<double> x, y;  // as long as each other; what is not finite, or not > 0 on a logarithmic axis, is a gap
  bool marks = false;        // a dot at each point
  bool line = true;          // from point to point
};

/// A value, or with `high` a band, to hold the curves against. A band may have no end: infinite.
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

/// The chart, 680 x 400 pixels, and more below for the legend. Colours are Okabe and Ito's, which the colour-blind tell
/// apart.
Svg draw(const Plot& plot);

/// The curves as a table: curve, x, y.
std::string plot_csv(const Plot& plot);

/// Round values from `low` to `high` for an axis: steps of 1, 2 or 5 times a power of ten, or of 1 and more where they
/// are to be `whole`; powers of ten (and 2 and 5 times these where there are few) on a logarithmic one.
std::vector<double> axis_ticks(double low, double high, bool logarithmic, bool whole = false);

}  // namespace plica
