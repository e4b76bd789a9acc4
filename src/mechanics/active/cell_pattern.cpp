#include "mechanics/active/cell_pattern.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace plica {
namespace {

// Coordinates of all cells' centres along an axis, um, across from the mean direction of the chosen ones.
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
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (axis == PatternAxis::along) {
      result.push_back(cell_centre(tissue.cells[c], tissue.rest_positions).x());
    } else if (!tissue.outer_shape) {
      result.push_back(from_axis(c).y());
    } else {
      const double turn = std::remainder(angle(from_axis(c)) - middle, 2 * std::numbers::pi);
      result.push_back(from_axis(c).norm() * turn);
    }
  }
  return result;
}

struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
};

Extent extent_of(const std::vector<double>& values, const CellSet& cells) {
  Extent extent;
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (cells[c]) extent = {std::min(extent.low, values[c]), std::max(extent.high, values[c])};
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

// Mean width of the chosen cells along an axis, um: half-way up, as distances are measured between centres. (Cells of a
// round embryo are wider at the apex.)
double mean_width(const Tissue& tissue, const CellSet& cells, PatternAxis axis) {
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

// From 1 to 0 over a length, as a cosine.
double fading(double way, double length) {
  if (way <= 0) return 1;
  return way < length ? 0.5 * (1 + std::cos(std::numbers::pi * (way / length))) : 0;
}

}  // namespace

double StrengthProfile::nearness(double distance) const {
  switch (shape) {
    case Shape::constant:
      return 1;
    case Shape::linear:
      return 1 - std::min(1.0, distance / half_width);
    case Shape::gaussian:
      return std::exp(-0.5 * (distance / sigma) * (distance / sigma));
    case Shape::plateau:
      return fading(distance - half_width, fade);
  }
  return 1;
}

double Taper::nearness(double distance) const { return fade > 0 ? fading(distance - 0.5 * full_length, fade) : 1; }

double chance_factor(double spread, std::uint64_t seed, std::size_t cell) {
  if (spread <= 0) return 1;
  const std::uint64_t first = mixed(mixed(seed) + cell), second = mixed(first);
  // Box and Muller's normal deviate; the factor's logarithm has the variance s2 and the mean -s2/2.
  const double normal = std::sqrt(-2 * std::log(uniform(first))) * std::cos(2 * std::numbers::pi * uniform(second));
  const double s2 = std::log(1 + spread * spread);
  return std::exp(std::sqrt(s2) * normal - 0.5 * s2);
}

CellPattern::CellPattern(const CellSet& who)
    : cells(who), strengths(who.begin(), who.end()), delays_s(who.size(), 0.0) {}

CellPattern CellPattern::after_division(const Division& division) const {
  CellPattern after;
  if (cells.empty()) return after;
  after.cells = inherited(division, cells);
  after.strengths = inherited(division, strengths);
  after.delays_s = inherited(division, delays_s);
  return after;
}

CellPattern cell_pattern(const Tissue& tissue, const CellSet& cells, const PatternRule& pattern) {
  CellPattern result(cells);
  const CellSet& about = pattern.about ? *pattern.about : cells;
  StrengthProfile profile = pattern.profile;
  if (profile.in_cells) {
    const double width = mean_width(tissue, about, profile.axis);
    for (double* length : {&profile.half_width, &profile.sigma, &profile.fade}) *length *= width;
  }
  const auto from_middle = [&](PatternAxis axis) {
    std::vector<double> places = coordinates(tissue, about, axis);
    const Extent extent = extent_of(places, about);
    for (double& place : places) place = std::abs(place - 0.5 * (extent.low + extent.high));
    return places;
  };
  const std::vector<double> place = from_middle(profile.axis), along = from_middle(PatternAxis::along);
  const std::vector<double> way = coordinates(tissue, cells, pattern.delay.axis);
  const Extent ways = extent_of(way, cells);
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (!cells[c]) continue;
    const double nearness = profile.nearness(place[c]) * pattern.taper.nearness(along[c]);
    result.strengths[c] =
        (pattern.edge + (pattern.middle - pattern.edge) * nearness) * chance_factor(pattern.spread, pattern.seed, c);
    if (pattern.delay.speed > 0)
      result.delays_s[c] = std::max(0.0, distance_from(pattern.delay.from, way[c], ways)) / pattern.delay.speed;
  }
  return result;
}

}  // namespace plica
