// Content of pages about many runs: charts with data, curves of time series, pictures if possible.
#pragma once

#include <optional>
#include <string>

#include "record/results.hpp"
#include "show/document.hpp"
#include "show/picture.hpp"
#include "show/plot.hpp"

namespace plica {

/// Figure with a plot and its data.
Figure chart(const std::string& name, const Plot& plot, const std::string& caption);

/// Column of a series over time, in s or, with a factor, another unit. Throws std::bad_optional_access for an unknown
/// column.
Curve column_of(const Series& series, const std::string& name, const std::string& column, double time_factor = 1);

/// Painter created at its first use; repeats the same error if nothing can be drawn.
class LazyPainter {
 public:
  /// Throws FileError as Painter does.
  Painter& operator*();

 private:
  std::optional<Painter> painter_;
  std::string why_none_;
};

}  // namespace plica
