#include "simulation/division_rules.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/clock.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

// Polygon of a cell at half its height.
std::vector<Vec3> mid_polygon(const Cell& cell, const Vectors& positions) {
  std::vector<Vec3> corners;
  for (std::size_t i = 0; i < cell.sides(); ++i)
    corners.push_back(0.5 * (positions[cell.basal_corners()[i].index()] + positions[cell.apical_corners()[i].index()]));
  return corners;
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

double elongation(const Cell& cell, const Vectors& positions) {
  const std::vector<Vec3> corners = mid_polygon(cell, positions);
  if (!cell.is_of_grid) {
    const Spread spread = spread_of(corners);
    return spread.longest / spread.least;
  }
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

// Element quality of both halves.
double quality_of_halves(const CellCut& cut, const std::vector<Vec3>& corners, bool bends) {
  const auto quality = [](const std::vector<Vec3>& half) {
    const PrismCorners prism = prism_of(half);
    const auto worst = [&](const std::vector<OutlineQuad>& split) { return worst_part(prism, split); };
    return worst(best_split(corners_of_polygon(prism.apical.size()), worst));
  };
  const auto [low, high] = halves_of_prism(cut, corners, bends);
  return std::min(quality(low), quality(high));
}

// Best cut between midpoints of two walls: minimizes the squared sine of its angle to the normal of the axis plus the
// squared sixfold deficit of the smaller half. Cuts with poor elements, in the reference or current state, rank last.
CellCut cut_of_polygon(DivisionPlane plane, CellId id, const std::vector<Vec3>& corners, const Tissue& tissue,
                       const Vectors& positions) {
  const Spread spread = spread_of(corners);
  const int n = static_cast<int>(corners.size());
  Vec3 axis = spread.along;
  if (plane != DivisionPlane::longest_axis) {
    const Vec3 wanted = Vec3::Unit(plane == DivisionPlane::transverse ? 0 : 1);
    const Vec3 seen = wanted - spread.outward.dot(wanted) * spread.outward;
    if (seen.norm() > 1e-6) axis = seen.normalized();  // else it is normal to the cell: any axis will do
  }
  const auto corner = [&](int i) -> const Vec3& { return corners[i % n]; };
  std::vector<std::pair<double, CellCut>> cuts;
  for (int first = 0; first < n; ++first)
    for (int second = first + 1; second < n; ++second) {
      const Vec3 from = 0.5 * (corner(first) + corner(first + 1)), to = 0.5 * (corner(second) + corner(second + 1));
      double part = 0, whole = 0;  // twice the areas
      for (int i = 0; i < n; ++i) whole += corner(i).cross(corner(i + 1)).dot(spread.outward);
      Vec3 last = from;
      for (int i = first + 1; i <= second; ++i) {
        part += last.cross(corner(i)).dot(spread.outward);
        last = corner(i);
      }
      part += (last.cross(to) + to.cross(from)).dot(spread.outward);
      const double sine = (to - from).normalized().dot(axis), lacks = 6 * (part / whole - 0.5);
      // Compare a fixed number of digits, so that ties up to rounding keep their order.
      cuts.emplace_back(std::round((sine * sine + lacks * lacks) / tie), CellCut{id, first, second});
    }
  std::ranges::stable_sort(cuts, {}, &std::pair<double, CellCut>::first);
  const Cell& cell = tissue.cells[id.index()];
  std::vector<Vec3> now;
  for (const NodeId corner_node : cell.corners) now.push_back(positions[corner_node.index()]);
  const bool bends = cuts_bend(tissue, id);
  const auto sound = std::ranges::find_if(cuts, [&](const auto& one) {
    return std::min(quality_of_halves(one.second, cell.rest_shape, bends), quality_of_halves(one.second, now, bends)) >
           least_quality;
  });
  return (sound == cuts.end() ? cuts.front() : *sound).second;
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
      for (const Cell& cell : model.tissue.cells) values.push_back(elongation(cell, state.positions));
      return values;
    }
    case DivisionTrigger::time:
      break;
  }
  return {};
}

}  // namespace

CellCut cut_by(DivisionPlane plane, const Tissue& tissue, CellId id, const Vectors& positions) {
  const Cell& cell = tissue.cells[id.index()];
  const std::vector<Vec3> corners = mid_polygon(cell, positions);
  return cell.is_of_grid ? cut_of_grid(plane, id, corners) : cut_of_polygon(plane, id, corners, tissue, positions);
}

std::vector<PlannedDivision> due_divisions(const Model& model, const State& state,
                                           std::span<const DivisionRule> rules) {
  std::vector<PlannedDivision> due;
  std::vector<char> growing(model.tissue.cells.size(), 0), chosen(model.tissue.cells.size(), 0);
  for (const Growth& growth : model.growths) growing[growth.cell.index()] = !has_come(growth.end_s, state.time_s);
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
      if (!region[c] || chosen[c] || model.tissue.cells[c].lineage.generation >= rule.max_generation) continue;
      if (!at_a_time && (growing[c] || !(values[c] > rule.threshold))) continue;
      chosen[c] = 1;
      due.push_back({cut_by(rule.plane, model.tissue, CellId(c), state.positions), rule.growth_s, rule.volume_ratio});
    }
  }
  return due;
}

}  // namespace plica
