#include "measure/region_shape.hpp"

#include <Eigen/QR>
#include <cmath>

#include "measure/cells.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

// Coefficients of the height a + b x + c y + d x^2/2 + e x y + f y^2/2 over a plane; in a slice, all of x are 0.
std::optional<std::array<double, 6>> fit_quadric(const Eigen::MatrixX3d& points, bool is_endless) {
  const Eigen::Index first = is_endless ? 3 : 0, count = is_endless ? 3 : 6;
  Eigen::MatrixXd powers(points.rows(), 6);
  const auto x = points.col(0).array(), y = points.col(1).array();
  powers << x, 0.5 * x * x, x * y, Eigen::ArrayXd::Ones(points.rows()), y, 0.5 * y * y;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> fit(powers.middleCols(first, count));
  fit.setThreshold(1e-9);
  if (points.rows() < count || fit.rank() < count) return std::nullopt;
  Eigen::VectorXd all = Eigen::VectorXd::Zero(6);
  all.segment(first, count) = fit.solve(points.col(2));
  return std::array{all[3], all[0], all[4], all[1], all[2], all[5]};
}

}  // namespace

std::optional<double> curvature_per_um(const Tissue& tissue, CellSide side, const CellSet& region,
                                       std::optional<int> axis, std::span<const Vec3> positions) {
  std::vector<bool> is_of_region(tissue.node_count(), false);
  Facing facing;
  for (const Facet& facet : tissue.facets(side)) {
    if (!region[facet.cell.index()]) continue;
    for (const NodeId node : facet.nodes) is_of_region[node.index()] = true;
    facing.add(gather(positions, facet));
  }
  Vectors points;
  for (std::size_t n = 0; n < is_of_region.size(); ++n)
    if (is_of_region[n]) points.push_back(positions[n]);
  if (!facing.is_one_way()) return std::nullopt;
  const Vec3 normal = (side == CellSide::apical ? 1 : -1) * facing.area_vectors.normalized();
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : points) middle += point / static_cast<double>(points.size());
  const auto in_surface = [&](const Vec3& way) { return Vec3(way - way.dot(normal) * normal); };
  const Vec3 way = in_surface(Vec3::Unit(axis.value_or(0)));
  if (axis && way.squaredNorm() < 1e-6) return std::nullopt;
  const Vec3 u = tissue.is_endless ? Vec3(Vec3::UnitX()) : normal.unitOrthogonal(), v = normal.cross(u);
  Eigen::MatrixX3d local(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 from = points[i] - middle;
    local.row(static_cast<Eigen::Index>(i)) << from.dot(u), from.dot(v), from.dot(normal);
  }
  const auto quadric = fit_quadric(local, tissue.is_endless);
  if (!quadric) return std::nullopt;
  const auto [a, b, c, d, e, f] = *quadric;
  const double steepness = 1 + b * b + c * c;
  if (!axis) return -((1 + c * c) * d - 2 * b * c * e + (1 + b * b) * f) / (2 * std::pow(steepness, 1.5));
  const double p = way.normalized().dot(u), q = way.normalized().dot(v);
  return -(p * p * d + 2 * p * q * e + q * q * f) / ((1 + std::pow(p * b + q * c, 2)) * std::sqrt(steepness));
}

CellsAround cells_around_region(const Tissue& tissue, const CellSet& region, std::span<const CellId> cells) {
  const CellSet around = cells_around(tissue, region, 1);
  CellsAround result;
  Vectors places;
  for (std::size_t c = 0; c < around.size(); ++c) {
    if (!around[c]) continue;
    result.cells.emplace_back(c);
    places.push_back(mean_apical(tissue.cells[c], tissue.rest_positions));
  }
  for (const CellId cell : cells) {
    const Vec3 at_rest = mean_apical(tissue.cells[cell.index()], tissue.rest_positions);
    std::vector<double>& weights = result.weights.emplace_back();
    double sum = 0;
    for (const Vec3& place : places) sum += weights.emplace_back(1 / std::pow((place - at_rest).squaredNorm(), 2));
    for (double& weight : weights) weight /= sum;
  }
  return result;
}

std::vector<double> depths_below_border_um(const Tissue& tissue, const CellSet& region, std::span<const CellId> cells,
                                           std::span<const Vec3> positions) {
  const CellsAround around = cells_around_region(tissue, region, cells);
  if (around.cells.empty()) return {};
  const auto moved = [&](CellId id) {
    const Cell& cell = tissue.cells[id.index()];
    return Vec3(mean_apical(cell, positions) - mean_apical(cell, tissue.rest_positions));
  };
  Vectors risen;
  for (const CellId cell : around.cells) risen.push_back(moved(cell));
  const std::vector<Vec3> normals = rest_apical_normals(tissue, cells);
  std::vector<double> depths;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    Vec3 below = -moved(cells[i]);
    for (std::size_t k = 0; k < risen.size(); ++k) below += around.weights[i][k] * risen[k];
    depths.push_back(normals[i].dot(below));
  }
  return depths;
}

}  // namespace plica
