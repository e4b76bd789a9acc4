#include "show/chart.hpp"

#include "core/errors.hpp"

namespace plica {

Figure chart(const std::string& name, const Plot& plot, const std::string& caption) {
  return {name, draw(plot).file(plot.title), caption, plot_csv(plot)};
}

Curve column_of(const Series& series, const std::string& name, const std::string& column, double time_factor) {
  Curve curve{name, {}, {}};
  const std::size_t place = series.column(column).value();
  for (const auto& row : series.rows)
    if (row[place]) curve.x.push_back(*row.front() * time_factor), curve.y.push_back(*row[place]);
  return curve;
}

Painter& LazyPainter::operator*() {
  if (!why_none_.empty()) throw FileError(why_none_);
  try {
    if (!painter_) painter_.emplace();
  } catch (const FileError& error) {
    why_none_ = error.what();
    throw;
  }
  return *painter_;
}

}  // namespace plica
