#include "measure/furrow.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "measure/cells.hpp"
#include "measure/closing.hpp"
#include "measure/measure_set.hpp"
#include "measure/observation.hpp"
#include "tissue/faces.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

constexpr int axis_x = 0, axis_y = 1;
constexpr double same_place_um = 1e-6;  // tolerance for mirror images in the reference state

std::vector<bool> facets_of(const Tissue& tissue, const CellSet& cells) {
  std::vector<bool> wanted;
  for (const Facet& facet : tissue.apical_facets) wanted.push_back(cells[facet.cell.index()]);
  return wanted;
}

Vec3 rest_area_vector(const Tissue& tissue, const Facet& facet) {
  return facet_area_vector(gather(tissue.rest_positions, facet));
}

// Mean reference apical normal of cells, in the plane y = 0; ventral if the normals cancel.
Vec3 mean_outward(const Tissue& tissue, const CellSet& cells) {
  Vec3 sum = Vec3::Zero();
  double area = 0;
  for (const Facet& facet : tissue.apical_facets) {
    if (!cells[facet.cell.index()]) continue;
    const Vec3 of_facet = rest_area_vector(tissue, facet);
    sum += of_facet;
    area += of_facet.norm();
  }
  sum.y() = 0;
  if (sum.norm() <= 1e-6 * area) return -Vec3::UnitZ();
  // Exactly along the axis for cells distributed evenly about it.
  for (double& component : sum)
    if (std::abs(component) < 1e-6 * sum.norm()) component = 0;
  return sum.normalized();
}

// Facets oriented outward in the reference state.
std::vector<bool> outward_facets(const Tissue& tissue, const Vec3& outward) {
  std::vector<bool> wanted;
  for (const Facet& facet : tissue.apical_facets) wanted.push_back(rest_area_vector(tissue, facet).dot(outward) > 0);
  return wanted;
}

// Distance of a material point inside the shell, minus the reference value. Without a shell: inward displacement.
double depth_of(const Tissue& tissue, const Vec3& rest, const Vec3& now, const Vec3& outward) {
  if (!tissue.outer_shape) return (rest - now).dot(outward);
  return tissue.outer_shape->depth(now, outward) - tissue.outer_shape->depth(rest, outward);
}

double depth_of(const Tissue& tissue, const MaterialPoint& point, const Vec3& outward,
                std::span<const Vec3> positions) {
  return depth_of(tissue, point.at(tissue.rest_positions), point.at(positions), outward);
}

// Cut of the surface without the dimples of single faces: points that no inner node of a polygon moves.
std::vector<SurfacePoint> cut_without_dimples(const Tissue& tissue, std::span<const Vec3> positions, int axis,
                                              const std::vector<bool>& wanted) {
  const std::vector<bool> is_inner = inner_nodes_of_polygons(tissue);
  std::vector<SurfacePoint> points = cut_apical_surface(tissue, positions, axis, wanted);
  std::erase_if(points, [&](const SurfacePoint& point) {
    for (int i = 0; i < 4; ++i)
      if (point.weights[i] != 0 && is_inner[point.nodes[i].index()]) return true;
    return false;
  });
  return points;
}

// Cells with an apical facet that meets y = 0 in the reference state.
std::vector<CellId> cells_on_midline(const Tissue& tissue, const std::vector<bool>& facets) {
  std::set<CellId> cells;
  for (const SurfacePoint& point : cut_apical_surface(tissue, tissue.rest_positions, axis_y, facets))
    cells.insert(tissue.apical_facets[point.facet].cell);
  return {cells.begin(), cells.end()};
}

// Lips: points where the plane x = 0 leaves the contractile cells in the reference state, left (y < 0) and right.
bool find_lips(const Tissue& tissue, FurrowSites& sites) {
  // Boundary edges of the contractile facets.
  std::map<std::pair<NodeId, NodeId>, int> uses;
  const auto edge = [&](const Facet& facet, int i) { return std::minmax(facet.nodes[i], facet.nodes[(i + 1) % 4]); };
  for (const Facet& facet : tissue.apical_facets)
    if (sites.contractile[facet.cell.index()])
      for (int i = 0; i < 4; ++i) ++uses[edge(facet, i)];
  double left = 0, right = 0;
  for (const SurfacePoint& point :
       cut_apical_surface(tissue, tissue.rest_positions, axis_x, facets_of(tissue, sites.contractile))) {
    const Facet& facet = tissue.apical_facets[point.facet];
    for (int i = 0; i < 4; ++i) {
      const bool on_edge = point.weights[i] + point.weights[(i + 1) % 4] > 1 - 1e-12;
      if (!on_edge || uses[edge(facet, i)] != 1) continue;
      const double y = point.at(tissue.rest_positions).y();
      if (y < left) left = y, sites.lips[0] = point;
      if (y > right) right = y, sites.lips[1] = point;
    }
  }
  return left < 0 && right > 0;
}

// Reference midline cells on the side of the furrow, anterior to posterior. Of two that meet there, the right one (y >
// 0) represents both.
std::vector<CellId> midline_of(const Tissue& tissue, const Vec3& outward) {
  std::vector<CellId> midline = cells_on_midline(tissue, outward_facets(tissue, outward));
  std::erase_if(midline, [&](CellId cell) {
    return cell_centre(tissue.cells[cell.index()], tissue.rest_positions).y() < -same_place_um;
  });
  std::ranges::stable_sort(
      midline, {}, [&](CellId cell) { return cell_centre(tissue.cells[cell.index()], tissue.rest_positions).x(); });
  return midline;
}

}  // namespace

FurrowSites choose_furrow_sites(const Tissue& tissue, const CellSet& contractile, int vce_from_end) {
  FurrowSites sites;
  sites.contractile = contractile;
  sites.outward = mean_outward(tissue, contractile);
  sites.midline = midline_of(tissue, sites.outward);
  const auto rest_x = [&](CellId cell) { return cell_centre(tissue.cells[cell.index()], tissue.rest_positions).x(); };

  // Distinct distances of contractile midline cells from the centre, each with its cells.
  std::vector<std::pair<double, MonitoredCells>> by_distance;
  for (const CellId cell : cells_on_midline(tissue, facets_of(tissue, contractile))) {
    const double distance = std::abs(rest_x(cell));
    const auto found = std::find_if(by_distance.begin(), by_distance.end(), [&](const auto& entry) {
      return std::abs(entry.first - distance) < same_place_um;
    });
    if (found != by_distance.end())
      found->second.push_back(cell);
    else
      by_distance.push_back({distance, {cell}});
  }
  std::sort(by_distance.begin(), by_distance.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  sites.midline_pairs = static_cast<int>(by_distance.size());
  if (!by_distance.empty()) {
    sites.vml = by_distance.front().second;
    const int last = static_cast<int>(by_distance.size()) - 1;
    sites.vce = by_distance[std::max(0, last - (vce_from_end - 1))].second;
  }
  sites.has_lips = find_lips(tissue, sites);
  return sites;
}

void follow_division(FurrowSites& sites, const Tissue& tissue, const TissueChange& change) {
  sites.contractile = inherited(change, sites.contractile);
  sites.midline = midline_of(tissue, sites.outward);
  for (MonitoredCells* cells : {&sites.vml, &sites.vce}) {
    const MonitoredCells before = *cells;
    for (const auto& [low, high] : change.daughters)
      if (std::ranges::find(before, low) != before.end()) cells->push_back(high);
  }
}

std::optional<double> furrow_depth_um(const Tissue& tissue, const FurrowSites& sites, std::span<const Vec3> positions) {
  const auto deepest = deepest_point(tissue, sites, positions);
  return deepest ? std::optional(depth_of(tissue, *deepest, sites.outward, positions)) : std::nullopt;
}

std::optional<SurfacePoint> deepest_point(const Tissue& tissue, const FurrowSites& sites,
                                          std::span<const Vec3> positions) {
  std::optional<SurfacePoint> deepest;
  double depth = 0;
  for (const SurfacePoint& point :
       cut_without_dimples(tissue, positions, axis_y, facets_of(tissue, sites.contractile))) {
    const double here = depth_of(tissue, point, sites.outward, positions);
    if (deepest && here <= depth) continue;
    deepest = point;
    depth = here;
  }
  return deepest;
}

double inward_depth_um(const Tissue& tissue, const FurrowSites& sites, const Vec3& place) {
  return tissue.outer_shape ? tissue.outer_shape->depth(place, sites.outward) : -place.dot(sites.outward);
}

LipShape lip_shape(const Tissue& tissue, const FurrowSites& sites, std::span<const Vec3> positions) {
  LipShape shape;
  if (!sites.has_lips) return shape;

  const Vec3 left = sites.lips[0].at(positions), right = sites.lips[1].at(positions);
  shape.lip_distance_um = (right - left).norm();
  const auto height = [&](const Vec3& p) { return p.dot(sites.outward); };
  std::map<CellId, Vectors> of_cells;  // section
  for (const SurfacePoint& cut : cut_without_dimples(tissue, positions, axis_x, outward_facets(tissue, sites.outward)))
    of_cells[tissue.apical_facets[cut.facet].cell].push_back(cut.at(positions));
  // Furrow bottom: the lowest place where a cell's section crosses y = 0. Once the furrow is closed, its walls do so,
  // too.
  std::optional<double> floor;
  Vec3 highest_left = -1e300 * sites.outward, highest_right = highest_left;
  for (auto& [cell, points] : of_cells) {
    std::ranges::stable_sort(points, {}, [](const Vec3& p) { return p.y(); });
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec3& p = points[i];
      if (p.y() <= 0 && height(p) > height(highest_left)) highest_left = p;
      if (p.y() >= 0 && height(p) > height(highest_right)) highest_right = p;
      if (i == 0 || points[i - 1].y() > 0 || p.y() < 0) continue;
      const Vec3& before = points[i - 1];
      const double width = p.y() - before.y(), part = width > 0 ? -before.y() / width : 0;
      const double crossing = (1 - part) * height(before) + part * height(p);
      if (!floor || crossing < *floor) floor = crossing;
    }
  }
  if (floor) {
    shape.depth_below_lips_um = 0.5 * (height(left) + height(right)) - *floor;
    shape.highest_points_distance_um = (highest_right - highest_left).norm();
  }
  return shape;
}

std::vector<std::optional<double>> cell_depths_um(const Tissue& tissue, const FurrowSites& sites,
                                                  std::span<const CellId> cells, std::span<const Vec3> positions) {
  CellSet wanted(tissue.cells.size(), false);
  for (const CellId cell : cells) wanted[cell.index()] = true;
  struct Sum {
    double depth = 0;
    int points = 0;
  };
  // A cell that borders the plane counts as cut there, even if its nodes have moved slightly off it.
  constexpr double at_plane_um = 0.05;
  Vectors snapped(positions.begin(), positions.end());
  for (Vec3& x : snapped)
    if (std::abs(x[axis_y]) < at_plane_um) x[axis_y] = 0;
  std::map<CellId, Sum> sums;
  for (const SurfacePoint& point : cut_without_dimples(tissue, snapped, axis_y, facets_of(tissue, wanted))) {
    Sum& sum = sums[tissue.apical_facets[point.facet].cell];
    sum.depth += depth_of(tissue, point, sites.outward, positions);
    ++sum.points;
  }
  std::vector<std::optional<double>> depths(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (const auto sum = sums.find(cells[i]); sum != sums.end()) depths[i] = sum->second.depth / sum->second.points;
  return depths;
}

std::optional<double> midline_waviness_um(const Tissue& tissue, const FurrowSites& sites,
                                          std::span<const Vec3> positions) {
  constexpr int terms = 5, fewest_cells = 10;
  std::vector<std::pair<double, double>> points;  // reference x, depth
  for (const CellId id : sites.midline) {
    if (!sites.contractile[id.index()]) continue;
    const Cell& cell = tissue.cells[id.index()];
    const Vec3 rest = mean_apical(cell, tissue.rest_positions);
    points.emplace_back(rest.x(), depth_of(tissue, rest, mean_apical(cell, positions), sites.outward));
  }
  if (points.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(points.begin(), points.end());  // by x
  const double first = least->first, last = most->first;
  const double middle = 0.5 * (first + last), reach = 0.25 * (last - first);
  std::erase_if(points, [&](const auto& point) { return std::abs(point.first - middle) > reach; });
  if (points.size() < fewest_cells) return std::nullopt;

  const auto count = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd powers(count, terms);
  Eigen::VectorXd depths(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [x, depth] = points[static_cast<std::size_t>(i)];
    for (int k = 0; k < terms; ++k) powers(i, k) = std::pow((x - middle) / reach, k);
    depths[i] = depth;
  }
  const Eigen::VectorXd smooth = powers.householderQr().solve(depths);
  return (powers * smooth - depths).norm() / std::sqrt(static_cast<double>(count));
}

namespace {

using enum InSummary;
using M = ColumnInput;

const FurrowSites& sites_of(const M& m) { return m.of_set<FurrowSites>(); }

LipShape lips_of_step(const M& m) { return lip_shape(m.model.tissue, sites_of(m), m.state.positions); }

// Displacements, and for steps speeds, of the furrow's centre and ends.
FurrowSpeeds speeds_of_step(const M& m) {
  const FurrowSites& sites = sites_of(m);
  const Tissue& tissue = m.model.tissue;
  FurrowSpeeds row;
  row.time_s = m.state.time_s;
  row.vml_displacement_um = mean_node_displacement(tissue, sites.vml, m.state.positions);
  row.vce_displacement_um = mean_node_displacement(tissue, sites.vce, m.state.positions);
  if (m.step == nullptr) return row;
  row.vml_speed_um_per_s = mean_speed(tissue, sites.vml, m.state.velocities);
  row.vce_speed_um_per_s = mean_speed(tissue, sites.vce, m.state.velocities);
  return row;
}

// Time series of a column, without missing values.
struct TimeSeries {
  std::vector<double> times_s, values;
};

TimeSeries time_series_of(std::span<const Observation> rows, std::string_view column) {
  TimeSeries series;
  for (const Observation& row : rows)
    if (const std::optional<double> value = row[column]) {
      series.times_s.push_back(row.time_s());
      series.values.push_back(*value);
    }
  return series;
}

Column::OfRun reaching(std::string_view column, double level) {
  return [=](std::span<const Observation> rows) {
    const TimeSeries series = time_series_of(rows, column);
    return time_of_reaching(series.times_s, series.values, level);
  };
}

SpeedHistory history_of(std::span<const Observation> rows) {
  std::vector<FurrowSpeeds> speeds;
  speeds.reserve(rows.size());
  for (const Observation& row : rows)
    speeds.push_back({row.time_s(), row["vml_speed_um_per_s"], row["vce_speed_um_per_s"], row["vml_displacement_um"],
                      row["vce_displacement_um"]});
  return speed_history(speeds);
}

Column of_run(std::string_view name, std::string_view meaning, Column::OfRun value) {
  return {name, whole_run, meaning, {}, std::move(value)};
}

Column of_history(std::string_view name, std::string_view meaning, std::optional<double> SpeedHistory::*number) {
  return of_run(name, meaning, [=](std::span<const Observation> rows) { return history_of(rows).*number; });
}

Column::OfRun of_knee(double Knee::*number) {
  return [=](std::span<const Observation> rows) -> std::optional<double> {
    const TimeSeries depth = time_series_of(rows, "furrow_depth_um");
    const std::optional<Knee> found = knee(depth.times_s, depth.values);
    return found ? std::optional((*found).*number) : std::nullopt;
  };
}

double vml_height(const M& m) {
  double sum = 0;
  for (const CellId cell : sites_of(m).vml) sum += cell_height(m.model.tissue.cells[cell.index()], m.state.positions);
  return sum / static_cast<double>(sites_of(m).vml.size());
}

std::vector<Column> columns_of_furrow() {
  return {
      {"furrow_depth_below_lips_um", last,
       "Depth of the furrow bottom (lowest place of the apical surface at x = y = 0) below the mean of both lips, "
       "positive inward. Negative for the convex reference shape; below 1 µm the ventral side is flat, not furrowed.",
       part_of(lips_of_step, &LipShape::depth_below_lips_um)},
      {"lip_distance_um", last, "Distance between the lips, which are material points. For contact, see `lips_closed`.",
       part_of(lips_of_step, &LipShape::lip_distance_um)},
      {"highest_points_distance_um", last,
       "Distance between the outermost points left and right of the midline at x = 0 (the paper's definition); may "
       "jump.",
       part_of(lips_of_step, &LipShape::highest_points_distance_um)},
      {"vml_speed_um_per_s", nothing,
       "Speed of the barycentre (mean of eight corners) of the central midline cell (VML).",
       part_of(speeds_of_step, &FurrowSpeeds::vml_speed_um_per_s)},
      {"vce_speed_um_per_s", nothing, "Speed of the barycentre of the near-end midline cell (VCE).",
       part_of(speeds_of_step, &FurrowSpeeds::vce_speed_um_per_s)},
      {"speed_ratio", nothing, "Speed of VCE / speed of VML, $v_c/v_m$.",
       [](const M& m) { return m.once(speeds_of_step).speed_ratio(); }},
      {"vml_displacement_um", last,
       "Mean displacement of the eight corner nodes of VML from the reference state (mean of lengths).",
       part_of(speeds_of_step, &FurrowSpeeds::vml_displacement_um)},
      {"vce_displacement_um", last, "Mean displacement of the corner nodes of VCE.",
       part_of(speeds_of_step, &FurrowSpeeds::vce_displacement_um)},
      {"vml_apical_area_ratio", last, "Apical area of VML / reference area; bilinear facets, 2 × 2 Gauss points.",
       [](const M& m) { return mean_apical_area_ratio(m.model.tissue, sites_of(m).vml, m.state.positions); }},
      {"vce_apical_area_ratio", last, "Apical area of VCE / reference area.",
       [](const M& m) { return mean_apical_area_ratio(m.model.tissue, sites_of(m).vce, m.state.positions); }},
      of_history(
          "peak_speed_ratio",
          "`speed_ratio` at the step with the largest difference $v_c-v_m$, among steps with $v_m$ above 1 % of its "
          "peak. Not the largest `speed_ratio`.",
          &SpeedHistory::peak_ratio),
      of_history("peak_speed_ratio_time_s", "End of that step.", &SpeedHistory::peak_ratio_time_s),
      of_history("ends_lead_until_s",
                 "First time after that step with $v_c\\le v_m$, interpolated; null if the ends never lead.",
                 &SpeedHistory::ends_lead_until_s),
      of_history("vml_displacement_at_equal_speed_um", "`vml_displacement_um` at that time.",
                 &SpeedHistory::vml_displacement_at_equal_speed_um),
      of_history("vce_displacement_at_equal_speed_um", "`vce_displacement_um` at that time.",
                 &SpeedHistory::vce_displacement_at_equal_speed_um),
      {"vml_height_um", largest, "Height of VML: mean length of its apicobasal edges.", vml_height},
      of_run("lips_closed_time_s", "First time with `lips_closed` = 1.", reaching("lips_closed", 1)),
      of_run("depth_20um_time_s", "Time at which `furrow_depth_um` reaches 20 µm.", reaching("furrow_depth_um", 20)),
      of_run(
          "knee_depth_um",
          "Depth at the onset of fast invagination: breakpoint of a two-segment fit to `furrow_depth_um` over time up "
          "to 20 µm (least squares, weighted by time); none if 20 µm are not reached.",
          of_knee(&Knee::depth_um)),
      of_run("knee_time_s", "Time of the onset of fast invagination.", of_knee(&Knee::time_s)),
      {"midline_waviness_um", last,
       "Waviness (buckling) of the furrow bottom along its length: root-mean-square deviation of the depths of "
       "contractile midline cells, middle half, from a quartic polynomial. None with fewer than ten cells.",
       [](const M& m) { return midline_waviness_um(m.model.tissue, sites_of(m), m.state.positions); }},
  };
}

// Whether a fold of the surface is a depression: in a ventral side, or in an open sheet.
bool is_open_sheet(const Tissue& tissue) {
  Facing facing;
  for (const Facet& facet : tissue.apical_facets) facing.add(gather(tissue.rest_positions, facet));
  return facing.is_one_way();
}

std::any begin_sites(const Subject& s) { return s.furrow.vml.empty() ? std::any() : s.furrow; }

void follow_sites(std::any& sites, const Tissue& tissue, const TissueChange& change) {
  follow_division(std::any_cast<FurrowSites&>(sites), tissue, change);
}

}  // namespace

MeasureSet fold_set() {
  return {"fold",
          "contracting cells on the plane y = 0",
          begin_sites,
          {{"furrow_depth_um", last,
            "Furrow depth: largest inward distance from the vitelline membrane over the apical midline (plane y = 0) "
            "of the furrow cells, without the middles of polygons, minus the reference value of the same material "
            "point. Inward: against the mean reference apical normal of these cells. Without an embryo shape: inward "
            "displacement.",
            [](const M& m) { return furrow_depth_um(m.model.tissue, sites_of(m), m.state.positions); }}},
          [](const Subject& s) { return s.is_embryo || is_open_sheet(s.model.tissue); },
          follow_sites};
}

MeasureSet furrow_set() {
  return {"furrow",
          "contracting cells on the plane y = 0",
          begin_sites,
          columns_of_furrow(),
          [](const Subject& s) { return s.is_embryo && !is_open_sheet(s.model.tissue); },
          follow_sites,
          "fold"};
}

}  // namespace plica
