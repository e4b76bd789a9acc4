#include "mechanics/active/cell_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tissue/faces.hpp"

namespace plica {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

// Coordinates of all cells' centres along an axis, um or degrees, across from the mean direction of the chosen ones.
std::vector<double> coordinates(const Tissue& tissue, const CellSet& cells, PatternAxis axis) {
  std::vector<double> result;
  Vec3 mean = Vec3::Zero();
  const auto from_axis = [&](std::size_t c) {
    const Vec3 centre = cell_centre(tissue.cells[c], tissue.rest_positions);
    return Vec3(0, centre.y(), centre.z());
  };
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c]) mean += from_axis(c).normalized();
  // Angles about x from the belly (-z) towards the right (+y). A region all around has no mean direction: the belly.
  const auto angle = [](const Vec3& v) { return std::atan2(v.y(), -v.z()); };
  const double middle = mean.norm() > 1e-6 ? angle(mean) : 0;
  const bool is_arc = axis == PatternAxis::across && goes_round(tissue);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (axis == PatternAxis::along) {
      result.push_back(cell_centre(tissue.cells[c], tissue.rest_positions).x());
    } else if (axis == PatternAxis::angle) {
      result.push_back(degrees * angle(from_axis(c)));
    } else if (!is_arc) {
      result.push_back(from_axis(c).y());
    } else {
      const double turn = std::remainder(angle(from_axis(c)) - middle, 2 * std::numbers::pi);
      result.push_back(from_axis(c).norm() * turn);
    }
  }
  return result;
}

Extent extent_of(const std::vector<double>& values, const CellSet& cells) {
  Extent extent;
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c]) extent.take(values[c]);
  return extent;
}

double distance_from(StartDelay::From from, double value, const Extent& extent) {
  using From = StartDelay::From;
  switch (from) {
    case From::middle:
      return std::abs(value - 0.5 * (extent.low + extent.high));
    case From::ends:
      return std::min(value - extent.low, extent.high - value);
    case From::low:
      return value - extent.low;
    case From::high:
      return extent.high - value;
  }
  return 0;
}

// Polygon at half height of a cell: area, and extent along and across the axis of the embryo.
struct PolygonSize {
  double area = 0, along = 0, across = 0;
};

PolygonSize size_half_way_up(const Tissue& tissue, const Cell& cell) {
  const std::size_t sides = cell.sides();
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < sides; ++i)
    points.push_back(0.5 * (tissue.rest_positions[cell.basal_corners()[i].index()] +
                            tissue.rest_positions[cell.apical_corners()[i].index()]));
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t i = 1; i + 1 < sides; ++i) twice_area += (points[i] - points[0]).cross(points[i + 1] - points[0]);
  const auto reach = [&](const Vec3& direction) {
    std::vector<double> places;
    for (const Vec3& x : points) places.push_back(direction.dot(x));
    const auto [low, high] = std::ranges::minmax(places);
    return high - low;
  };
  const Vec3 normal = twice_area.normalized(), along = Vec3::UnitX() - normal.x() * normal;
  if (along.norm() < 1e-3) return {};  // it faces along the axis
  return {0.5 * twice_area.norm(), reach(along.normalized()), reach(normal.cross(along).normalized())};
}

// Mean width of polygons along an axis: average length of their intersections with lines along it.
std::optional<double> mean_width_of_polygons(const Tissue& tissue, const CellSet& cells, PatternAxis axis) {
  double area = 0, reach = 0;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!cells[c] || tissue.cells[c].is_of_grid) continue;
    const PolygonSize size = size_half_way_up(tissue, tissue.cells[c]);
    area += size.area;
    reach += axis == PatternAxis::along ? size.across : size.along;
  }
  return reach > 0 ? std::optional(area / reach) : std::nullopt;
}

// Mean width of the chosen cells along an axis, um: half-way up, as distances are measured between centres. (Cells of a
// round embryo are wider at the apex.)
double mean_width(const Tissue& tissue, const CellSet& cells, PatternAxis axis) {
  if (const auto width = mean_width_of_polygons(tissue, cells, axis)) return *width;
  const EdgeDirection direction = axis == PatternAxis::along ? EdgeDirection::along : EdgeDirection::across;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (const CellEdge& edge : tissue.cells[c].edges) {
      if (!cells[c] || edge.side == CellSide::lateral || edge.direction != direction) continue;
      sum +=
          (tissue.rest_positions[edge.nodes.back().index()] - tissue.rest_positions[edge.nodes.front().index()]).norm();
      ++count;
    }
  return count == 0 ? 1 : sum / static_cast<double>(count);
}

// SplitMix64 (Steele, Lea and Flood 2014): a well mixed number for each place in a sequence.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9;
  value = (value ^ (value >> 27)) * 0x94d049bb133111eb;
  return value ^ (value >> 31);
}

// In (0, 1], from the upper 53 bits.
double uniform(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 1) * 0x1p-53; }

// Linear between points, as at the ends beyond them.
double between(const std::vector<double>& places, const std::vector<double>& values, double place) {
  const std::size_t next = std::ranges::upper_bound(places, place) - places.begin();
  if (next == 0) return values.front();
  if (next == places.size()) return values.back();
  const double part = (place - places[next - 1]) / (places[next] - places[next - 1]);
  return values[next - 1] + part * (values[next] - values[next - 1]);
}

// From 1 to 0 over a length, as a cosine.
double fading(double way, double length) {
  if (way <= 0) return 1;
  return way < length ? 0.5 * (1 + std::cos(std::numbers::pi * (way / length))) : 0;
}

}  // namespace

double StrengthProfile::of_array(double value) const {
  return std::clamp((value - array_0) / (array_1 - array_0), 0.0, 1.0);
}

double StrengthProfile::nearness(double place) const {
  const double distance = std::abs(place);
  switch (shape) {
    case Shape::constant:
      return 1;
    case Shape::linear:
      return 1 - std::min(1.0, distance / half_width);
    case Shape::gaussian:
      return std::exp(-0.5 * (distance / sigma) * (distance / sigma));
    case Shape::plateau:
      return fading(distance - half_width, fade);
    case Shape::table:
      return between(places, values, places.front() < 0 ? place : distance);
    case Shape::array:
      break;
  }
  return 1;
}

double Taper::nearness(double distance) const { return fade > 0 ? fading(distance - 0.5 * full_length, fade) : 1; }

// By Box and Muller.
double normal_deviate(std::uint64_t seed, std::uint64_t number) {
  const std::uint64_t first = mixed(mixed(seed) + number), second = mixed(first);
  return std::sqrt(-2 * std::log(uniform(first))) * std::cos(2 * std::numbers::pi * uniform(second));
}

std::uint64_t pair_number(int one, int other) {
  return mixed(mixed(static_cast<std::uint64_t>(one)) + static_cast<std::uint64_t>(other));
}

double chance_factor(double spread, std::uint64_t seed, std::uint64_t cell) {
  if (spread <= 0) return 1;
  // The factor's logarithm has the variance s2 and the mean -s2/2.
  const double s2 = std::log(1 + spread * spread);
  return std::exp(std::sqrt(s2) * normal_deviate(seed, cell) - 0.5 * s2);
}

// Places are distinguished by steps of 0.01 um. Their limits avoid round coordinates, where rounding would decide.
std::uint64_t place_number(const Vec3& place) {
  constexpr double apart_um = 0.01, offset = 0.381966;
  std::uint64_t number = 0;
  for (const double x : place) number = mixed(number ^ static_cast<std::uint64_t>(std::llround(x / apart_um + offset)));
  return number;
}

double CellPattern::pulse(CellId cell, double time_s) const {
  if (pulse_periods_s.empty()) return 1;
  const std::size_t c = cell.index();
  return 1 + pulse_amplitude * std::sin(2 * std::numbers::pi * (time_s / pulse_periods_s[c] + pulse_phases[c]));
}

Ablation::Ablation(CellSet who, double part, double at_s, std::optional<double> until_s, double recovery_s)
    : cells(std::move(who)),
      remaining(until_s ? Program({at_s, at_s, *until_s, *until_s + recovery_s}, {1, part, part, 1})
                        : Program({at_s, at_s}, {1, part})) {}

double CellPattern::remaining(CellId cell, double time_s, std::optional<double> height_percent) const {
  double part = 1;
  for (const Ablation& ablation : ablations) {
    const auto& range = ablation.height_percent;
    const bool is_there =
        !range || (height_percent && *height_percent >= (*range)[0] && *height_percent <= (*range)[1]);
    if (is_there && ablation.cells[cell.index()]) part *= ablation.remaining.at(time_s);
  }
  return part;
}

namespace {

std::vector<double> ordered_with(std::vector<double> times_s, const std::vector<double>& more_s) {
  times_s.insert(times_s.end(), more_s.begin(), more_s.end());
  std::ranges::sort(times_s);
  return times_s;
}

}  // namespace

std::vector<double> CellPattern::with_ablation_points(std::vector<double> times_s) const {
  for (const Ablation& ablation : ablations) times_s = ordered_with(std::move(times_s), ablation.remaining.times_s());
  return times_s;
}

std::vector<double> CellPattern::with_ablation_jumps(std::vector<double> times_s) const {
  for (const Ablation& ablation : ablations) times_s = ordered_with(std::move(times_s), ablation.remaining.jumps_s());
  return times_s;
}

CellPattern::CellPattern(const CellSet& who)
    : cells(who), strengths(who.begin(), who.end()), delays_s(who.size(), 0.0) {}

CellPattern CellPattern::after_change(const TissueChange& change) const {
  CellPattern after = *this;
  follow(change, after);
  return after;
}

namespace {

void add_pulses(const Tissue& tissue, const PulseRule& rule, CellPattern& pattern) {
  if (!(rule.period_s > 0)) return;
  pattern.pulse_amplitude = rule.amplitude;
  for (const Cell& cell : tissue.cells) {
    const std::uint64_t place = place_number(cell_centre(cell, tissue.rest_positions));
    pattern.pulse_periods_s.push_back(rule.period_s * chance_factor(rule.spread, rule.seed, place));
    pattern.pulse_phases.push_back(rule.together ? 0 : uniform(mixed(~mixed(rule.seed) + place)));
  }
}

}  // namespace

CellPattern cell_pattern(const Tissue& tissue, const CellSet& cells, const PatternRule& pattern) {
  CellPattern result(cells);
  const CellSet& about = pattern.about ? *pattern.about : cells;
  StrengthProfile profile = pattern.profile;
  if (profile.in_cells) {
    const double width = mean_width(tissue, about, profile.axis);
    for (double* length : {&profile.half_width, &profile.sigma, &profile.fade}) *length *= width;
    for (double& place : profile.places) place *= width;
  }
  const auto from_middle = [&](PatternAxis axis) {
    std::vector<double> places = coordinates(tissue, about, axis);
    const Extent extent = extent_of(places, about);
    const double middle = 0.5 * (extent.low + extent.high);
    for (double& place : places)
      place = axis == PatternAxis::angle ? std::remainder(place - profile.centre, 360) : place - middle;
    return places;
  };
  const std::vector<double> place = from_middle(profile.axis), along = from_middle(PatternAxis::along);
  const std::vector<double> way = coordinates(tissue, cells, pattern.delay.axis);
  const Extent ways = extent_of(way, cells);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!cells[c]) continue;
    const double of_profile = profile.shape == StrengthProfile::Shape::array ? profile.of_array(profile.array[c])
                                                                             : profile.nearness(place[c]);
    const double nearness = of_profile * pattern.taper.nearness(std::abs(along[c]));
    const std::uint64_t chance =
        pattern.by_place ? place_number(cell_centre(tissue.cells[c], tissue.rest_positions)) : c;
    result.strengths[c] = (pattern.edge + (pattern.middle - pattern.edge) * nearness) *
                          chance_factor(pattern.spread, pattern.seed, chance);
    if (pattern.delay.speed > 0)
      result.delays_s[c] = std::max(0.0, distance_from(pattern.delay.from, way[c], ways)) / pattern.delay.speed;
  }
  add_pulses(tissue, pattern.pulse, result);
  return result;
}

}  // namespace plica
