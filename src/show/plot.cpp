#include "show/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace plica {
namespace {

constexpr double width = 680, height = 400, left = 72, right = 20, top = 34, bottom = 52;
constexpr std::array colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7", "#000000", "#E69F00", "#56B4E9"};
constexpr std::array dashes = {"", "7 3", "2 3", "9 3 2 3", "", "7 3", "2 3"};

// Mapping of values to pixels along one axis.
struct Scale {
  double low = 0, high = 1, from = 0, to = 1;
  bool logarithmic = false;

  [[nodiscard]] bool shows(double value) const { return std::isfinite(value) && (!logarithmic || value > 0); }
  [[nodiscard]] double part(double value) const {
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  }
  [[nodiscard]] double pixel(double value) const { return from + (to - from) * std::clamp(part(value), -0.02, 1.02); }
};

Scale scale_of(const PlotAxis& axis, const std::vector<const std::vector<double>*>& data,
               const std::vector<Guide>& guides, double from, double to) {
  Scale scale{0, 1, from, to, axis.logarithmic};
  double low = INFINITY, high = -INFINITY;
  const auto take = [&](double value) {
    if (scale.shows(value)) low = std::min(low, value), high = std::max(high, value);
  };
  for (const auto* values : data)
    for (const double value : *values) take(value);
  for (const Guide& guide : guides) take(guide.at), take(guide.high.value_or(guide.at));
  if (!(low <= high)) low = axis.logarithmic ? 0.1 : 0, high = 1;
  if (low == high) low = axis.logarithmic ? low / 2 : low - 0.5, high = axis.logarithmic ? high * 2 : high + 0.5;
  if (axis.logarithmic) {
    low /= 1.3, high *= 1.3;
  } else {
    const double margin = 0.06 * (high - low);
    low = low >= 0 && low - margin < 0 ? 0 : low - margin;
    high += margin;
  }
  scale.low = axis.low.value_or(low);
  scale.high = axis.high.value_or(high);
  return scale;
}

std::string tick_label(double value) { return fmt::format("{:.4g}", std::abs(value) < 1e-12 ? 0.0 : value); }

void draw_axes(Svg& svg, const Plot& plot, const Scale& x, const Scale& y) {
  for (const double tick : axis_ticks(x.low, x.high, x.logarithmic, plot.x.whole)) {
    const double at = x.pixel(tick);
    svg.polyline({{at, height - bottom}, {at, top}}, "#e4e4e4", 0.7);
    svg.polyline({{at, height - bottom}, {at, height - bottom + 5}}, "#111", 1);
    svg.text({at, height - bottom + 18}, tick_label(tick), {.anchor = "middle"});
  }
  for (const double tick : axis_ticks(y.low, y.high, y.logarithmic, plot.y.whole)) {
    const double at = y.pixel(tick);
    svg.polyline({{left, at}, {width - right, at}}, "#e4e4e4", 0.7);
    svg.polyline({{left - 5, at}, {left, at}}, "#111", 1);
    svg.text({left - 8, at + 4}, tick_label(tick), {.anchor = "end"});
  }
  svg.polyline({{left, top}, {left, height - bottom}, {width - right, height - bottom}}, "#111", 1.2);
  svg.text({(left + width - right) / 2, height - 12}, plot.x.label, {.size = 13, .anchor = "middle"});
  svg.text({18, (top + height - bottom) / 2}, plot.y.label, {.size = 13, .anchor = "middle", .upwards = true});
  svg.text({left, 20}, plot.title, {.size = 14, .bold = true});
}

void draw_guides(Svg& svg, const Plot& plot, const Scale& x, const Scale& y) {
  for (const Guide& guide : plot.horizontal) {
    const double at = y.pixel(guide.at);
    const double upper = std::max(y.pixel(guide.high.value_or(guide.at)), top);
    if (guide.high)
      svg.rectangle({left, upper}, width - right - left, std::min(at, height - bottom) - upper, "#f1e9c9");
    else
      svg.polyline({{left, at}, {width - right, at}}, "#777", 1, "3 3");
    svg.text({left + 4, guide.high ? upper + 12 : at - 4}, guide.label, {.size = 11});
  }
  int row = 0;
  for (const Guide& guide : plot.vertical) {
    const double at = x.pixel(guide.at);
    svg.polyline({{at, top}, {at, height - bottom}}, "#777", 1, "3 3");
    const bool at_right_end = at > width - 190;
    svg.text({at + (at_right_end ? -4 : 4), top + 12 + 13.0 * row++}, guide.label,
             {.size = 11, .anchor = at_right_end ? "end" : "start"});
  }
}

void draw_curve(Svg& svg, const Curve& curve, std::size_t number, const Scale& x, const Scale& y) {
  std::vector<Pixel> points;
  const auto flush = [&] {
    if (points.size() > 1 && curve.line)
      svg.polyline(points, colours[number % colours.size()], 2, dashes[number % dashes.size()]);
    points.clear();
  };
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const bool inside = x.shows(curve.x[i]) && y.shows(curve.y[i]) && x.part(curve.x[i]) > -0.001 &&
                        x.part(curve.x[i]) < 1.001 && y.part(curve.y[i]) > -0.001 && y.part(curve.y[i]) < 1.001;
    if (!inside) {
      flush();
      continue;
    }
    points.push_back({x.pixel(curve.x[i]), y.pixel(curve.y[i])});
    if (curve.marks) svg.circle(points.back(), 3.5, colours[number % colours.size()]);
  }
  flush();
}

// Names below the chart, two per row.
void draw_legend(Svg& svg, const Plot& plot) {
  for (std::size_t i = 0; i < plot.curves.size(); ++i) {
    const std::size_t row = i / 2;
    const double x = left + (i % 2) * (width - left - right) / 2.0, y = height + 12 + 18.0 * static_cast<double>(row);
    if (plot.curves[i].line)
      svg.polyline({{x, y}, {x + 30, y}}, colours[i % colours.size()], 2, dashes[i % dashes.size()]);
    if (plot.curves[i].marks) svg.circle({x + 15, y}, 3.5, colours[i % colours.size()]);
    svg.text({x + 36, y + 4}, plot.curves[i].name);
  }
}

}  // namespace

std::vector<double> axis_ticks(double low, double high, bool logarithmic, bool whole) {
  std::vector<double> ticks;
  if (logarithmic) {
    const int decades = static_cast<int>(std::ceil(std::log10(high / low)));
    for (int power = static_cast<int>(std::floor(std::log10(low))); power <= std::ceil(std::log10(high)); ++power)
      for (const double digit : {1.0, 2.0, 5.0}) {
        const double tick = digit * std::pow(10.0, power);
        if (tick >= low * (1 - 1e-9) && tick <= high * (1 + 1e-9) && (digit == 1 || decades <= 3))
          ticks.push_back(tick);
      }
    return ticks;
  }
  const double raw = (high - low) / 6, unit = std::pow(10.0, std::floor(std::log10(raw)));
  double step = 10 * unit;
  for (const double digit : {5.0, 2.0, 1.0})
    if (digit * unit >= raw * (1 - 1e-9)) step = digit * unit;
  if (whole) step = std::max(step, 1.0);
  for (double number = std::ceil(low / step - 1e-9); number * step <= high + 1e-9 * step; ++number)
    ticks.push_back(number * step);
  return ticks;
}

Svg draw(const Plot& plot) {
  std::vector<const std::vector<double>*> xs, ys;
  for (const Curve& curve : plot.curves) xs.push_back(&curve.x), ys.push_back(&curve.y);
  const Scale x = scale_of(plot.x, xs, plot.vertical, left, width - right);
  const Scale y = scale_of(plot.y, ys, plot.horizontal, height - bottom, top);
  const std::size_t legend_rows = (plot.curves.size() + 1) / 2;
  const double legend = 18.0 * static_cast<double>(legend_rows) + 10;
  Svg svg(width, height + legend);
  draw_axes(svg, plot, x, y);
  draw_guides(svg, plot, x, y);
  for (std::size_t i = 0; i < plot.curves.size(); ++i) draw_curve(svg, plot.curves[i], i, x, y);
  draw_legend(svg, plot);
  return svg;
}

std::string plot_csv(const Plot& plot) {
  const auto quoted = [](const std::string& text) {
    return text.find(',') == std::string::npos ? text : "\"" + text + "\"";
  };
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.8g}", value) : std::string(); };
  std::string text = fmt::format("curve,{},{}\n", quoted(plot.x.label), quoted(plot.y.label));
  for (const Curve& curve : plot.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      text += fmt::format("{},{},{}\n", quoted(curve.name), number(curve.x[i]), number(curve.y[i]));
  return text;
}

}  // namespace plica
