// What pages of many runs show: charts with their data, curves of a run's series, pictures where they can be drawn.
#pragma once

#include <optional>
#include <string>

#include "record/results.hpp"
#include "show/document.hpp"
#include "show/picture.hpp"
#include "show/plot.hpp"

namespace plica {

/// The plot and its data as a figure of a page.
Figure chart(const std::string& name, const Plot& plot, const std::string& caption);

/// A column of a series over time, in s or, with a factor, in another unit. std::bad_optional_access when the series
/// has no such column.
Curve column_of(const Series& series, const std::string& name, const std::string& column, double time_factor = 1);

/// A painter that starts when it is first asked for. Where nothing can be drawn, the reason is the same each time.
class LazyPainter {
 public:
  /// FileError as of Painter.
  Painter& operator*();

 private:
  std::optional<Painter> painter_;
  std::string why_none_;
};

}  // namespace plica
