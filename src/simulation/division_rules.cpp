#include "simulation/division_rules.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "core/clock.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

// Corners of a grid cell at half its height.
std::vector<Vec3> mid_corners(const Cell& cell, const Vectors& positions) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < cell.sides(); ++i)
    corners.push_back(0.5 * (positions[cell.basal_corners()[i].index()] + positions[cell.apical_corners()[i].index()]));
  return corners;
}

// Stops of a polygon at half its height.
std::vector<Vec3> mid_outline(const Sheet& sheet, CellId cell, const Vectors& positions) {
  std::vector<Vec3> outline;
  for (const Stop& stop : sheet.cells[cell.index()].ring) {
    const std::vector<NodeId>& nodes = sheet.vertices[stop.vertex.index()].nodes;
    outline.push_back(0.5 * (positions[nodes.front().index()] + positions[nodes.back().index()]));
  }
  return outline;
}

// Mean vector along u (0) or v (1) of a grid cell.
Vec3 mean_side(const std::vector<Vec3>& corners, int along) {
  const Vec3 diagonal = corners[2] - corners[0], other = along == 0 ? corners[1] - corners[3] : corners[3] - corners[1];
  return 0.5 * (diagonal + other);
}

// Second moments of a polygon's area about its centroid, in its plane.
struct Spread {
  Vec3 outward;                   // of length 1
  double longest = 0, least = 0;  // axes of the equivalent ellipse
  Vec3 along;                     // direction of the longest axis
};

Spread spread_of(const std::vector<Vec3>& corners) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  Spread spread;
  spread.outward.setZero();
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    spread.outward += (corners[i] - middle).cross(corners[(i + 1) % corners.size()] - middle);
  spread.outward.normalize();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - middle, b = corners[(i + 1) % corners.size()] - middle;
    const double part = 0.5 * a.cross(b).dot(spread.outward);  // a triangle's area
    area += part;
    first += part / 3 * (a + b);
    second += part / 12 * (a * a.transpose() + b * b.transpose() + (a + b) * (a + b).transpose());
  }
  second = second / area - first / area * (first / area).transpose();
  const Mat3 in_plane = Mat3::Identity() - spread.outward * spread.outward.transpose();
  const Eigen::SelfAdjointEigenSolver<Mat3> axes(in_plane * second * in_plane);
  spread.longest = std::sqrt(std::max(0.0, axes.eigenvalues()[2]));
  spread.least = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  spread.along = axes.eigenvectors().col(2);
  return spread;
}

double elongation(const Tissue& tissue, CellId id, const Vectors& positions) {
  const Cell& cell = tissue.cells[id.index()];
  if (!cell.is_of_grid) {
    const Spread spread = spread_of(mid_outline(tissue.sheet, id, positions));
    return spread.longest / spread.least;
  }
  const std::vector<Vec3> corners = mid_corners(cell, positions);
  const double u = mean_side(corners, 0).norm(), v = mean_side(corners, 1).norm();
  return std::max(u, v) / std::min(u, v);
}

// Rounding must not decide ties, so that mirror images divide alike.
constexpr double tie = 1e-9;

constexpr double least_quality = 0.05;  // scaled Jacobian of a daughter's elements

CellCut cut_of_grid(DivisionPlane plane, CellId id, const std::vector<Vec3>& corners) {
  const Vec3 u = mean_side(corners, 0), v = mean_side(corners, 1);
  double along_u = u.norm(), along_v = v.norm();
  if (plane != DivisionPlane::longest_axis) {
    const int axis = plane == DivisionPlane::transverse ? 0 : 1;
    along_u = std::abs(u[axis]) / along_u;
    along_v = std::abs(v[axis]) / along_v;
  }
  return {id, along_u >= along_v * (1 - tie) ? 0 : 1};
}

// Where a cut may end: a stop of a polygon, or a place on the wall after it.
struct PossibleEnd {
  int side;
  double at;
  std::size_t stop;
  bool is_at_stop;
  Vec3 place;
};

// Ends at which three cells then meet: middles of walls, and vertices at which two cells meet.
std::vector<PossibleEnd> possible_ends(const Sheet& sheet, CellId id, const std::vector<Vec3>& outline,
                                       const CutEnds& taken) {
  const Polygon& polygon = sheet.cells[id.index()];
  const std::size_t n = polygon.ring.size();
  const auto beyond = [&](std::size_t i) { return sheet.walls[polygon.ring[i].wall.index()].beyond(id); };
  const auto is_open = [&](std::size_t i) {
    return polygon.ring[i].at > 0 && beyond(i) == beyond(i - 1) && !taken.stops.contains(polygon.ring[i].vertex);
  };
  std::vector<PossibleEnd> ends;
  int side = -1;
  for (std::size_t i = 0; i < n; ++i) {
    const Stop& stop = polygon.ring[i];
    if (stop.at == 0) ++side;
    if (is_open(i)) {
      ends.push_back({side, stop.at, i, true, outline[i]});
      continue;
    }
    const std::size_t next = (i + 1) % n;
    if (is_open(next)) continue;
    const auto add = [&](double low, double high, double part) {
      ends.push_back({side, 0.5 * (low + high), i, false, Vec3((1 - part) * outline[i] + part * outline[next])});
    };
    const double end = polygon.end_of(i), middle = 0.5 * (stop.at + end);
    if (taken.walls.contains(stop.wall)) {
      add(stop.at, middle, 0.25);
      add(middle, end, 0.75);
    } else {
      add(stop.at, end, 0.5);
    }
  }
  return ends;
}

// Twice the area of a polygon.
double twice_area(std::span<const Vec3> polygon, const Vec3& outward) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]).dot(outward);
  return sum;
}

// Best cut between two ends: minimizes the squared sine of its angle to the normal of the axis plus the squared sixfold
// deficit of the smaller half. Cuts with poor elements rank last.
CellCut cut_of_polygon(DivisionPlane plane, CellId id, const Tissue& tissue, const Vectors& positions, CutEnds& taken) {
  const std::vector<Vec3> outline = mid_outline(tissue.sheet, id, positions);
  const Spread spread = spread_of(outline);
  Vec3 axis = spread.along;
  if (plane != DivisionPlane::longest_axis) {
    const Vec3 wanted = Vec3::Unit(plane == DivisionPlane::transverse ? 0 : 1);
    const Vec3 seen = wanted - spread.outward.dot(wanted) * spread.outward;
    if (seen.norm() > 1e-6) axis = seen.normalized();  // else it is normal to the cell: any axis will do
  }
  const double whole = twice_area(outline, spread.outward);
  const std::vector<PossibleEnd> ends = possible_ends(tissue.sheet, id, outline, taken);
  std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
  for (std::size_t first = 0; first < ends.size(); ++first)
    for (std::size_t second = first + 1; second < ends.size(); ++second) {
      const PossibleEnd &from = ends[first], &to = ends[second];
      if (from.side == to.side) continue;
      std::vector<Vec3> half = {from.place};
      for (std::size_t i = from.stop + 1; i <= to.stop; ++i) half.push_back(outline[i]);
      half.push_back(to.place);
      const double part = twice_area(half, spread.outward);
      const double sine = (to.place - from.place).normalized().dot(axis), lacks = 6 * (part / whole - 0.5);
      // Compare a fixed number of digits, so that ties up to rounding keep their order.
      pairs.emplace_back(std::round((sine * sine + lacks * lacks) / tie), first, second);
    }
  std::ranges::stable_sort(pairs, {}, [](const auto& pair) { return std::get<0>(pair); });
  const auto cut_of = [&](const auto& pair) {
    const PossibleEnd &from = ends[std::get<1>(pair)], &to = ends[std::get<2>(pair)];
    return CellCut{id, from.side, to.side, from.at, to.at};
  };
  const auto sound = std::ranges::find_if(
      pairs, [&](const auto& pair) { return quality_of_daughters(tissue, cut_of(pair), positions) > least_quality; });
  const auto& chosen = sound == pairs.end() ? pairs.front() : *sound;
  for (const std::size_t end : {std::get<1>(chosen), std::get<2>(chosen)}) {
    const Stop& stop = tissue.sheet.cells[id.index()].ring[ends[end].stop];
    if (ends[end].is_at_stop)
      taken.stops.insert(stop.vertex);
    else
      taken.walls.insert(stop.wall);
  }
  return cut_of(chosen);
}

// Quantity compared with the rule's threshold, for each cell.
std::vector<double> measured(DivisionTrigger trigger, const Model& model, const State& state) {
  switch (trigger) {
    case DivisionTrigger::apical_area:
      return face_areas(model.tissue, CellSide::apical, state.positions);
    case DivisionTrigger::volume:
      return model.volumes.volumes(state.positions);
    case DivisionTrigger::elongation: {
      std::vector<double> values;
      for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
        values.push_back(elongation(model.tissue, CellId(c), state.positions));
      return values;
    }
    case DivisionTrigger::time:
      break;
  }
  return {};
}

}  // namespace

CellCut cut_by(DivisionPlane plane, const Tissue& tissue, CellId id, const Vectors& positions, CutEnds& taken) {
  const Cell& cell = tissue.cells[id.index()];
  return cell.is_of_grid ? cut_of_grid(plane, id, mid_corners(cell, positions))
                         : cut_of_polygon(plane, id, tissue, positions, taken);
}

std::vector<PlannedDivision> due_divisions(const Model& model, const State& state, std::span<const DivisionRule> rules,
                                           std::span<const ExtrusionRule> extrusions) {
  std::vector<PlannedDivision> due;
  if (rules.empty()) return due;
  std::vector<char> growing(model.tissue.cells.size(), 0);
  CellSet is_out = leaving_cells(model, state, extrusions);  // leaving, or chosen already
  for (const Growth& growth : model.growths) growing[growth.cell.index()] = !has_come(growth.end_s, state.time_s);
  CutEnds taken;
  for (const DivisionRule& rule : rules) {
    const bool at_a_time = rule.trigger == DivisionTrigger::time;
    if (at_a_time && (has_come(rule.threshold, state.divided_until_s) || !has_come(rule.threshold, state.time_s)))
      continue;
    if (!at_a_time && rule.every_s > 0 &&
        !has_come((std::floor((state.divided_until_s + instant_s) / rule.every_s) + 1) * rule.every_s, state.time_s))
      continue;
    const std::vector<double> values = measured(rule.trigger, model, state);
    const CellSet& region = model.tissue.regions.at(rule.region);
    for (std::size_t c = 0; c < region.size(); ++c) {
      if (!region[c] || is_out[c] || model.tissue.cells[c].lineage.generation >= rule.max_generation) continue;
      if (!at_a_time && (growing[c] || !(values[c] > rule.threshold))) continue;
      is_out[c] = true;
      due.push_back(
          {cut_by(rule.plane, model.tissue, CellId(c), state.positions, taken), rule.growth_s, rule.volume_ratio});
    }
  }
  return due;
}

}  // namespace plica
