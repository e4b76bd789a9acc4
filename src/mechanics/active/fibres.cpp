#include "mechanics/active/fibres.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "mechanics/active/shape_activation.hpp"

namespace plica {
namespace {

constexpr double least_in_surface = 1e-6;  // squared length of an axis of length 1

// Tangents a, b of a face at a Gauss point, and their product n.
struct Tangents {
  Vec3 a, b, n;

  Tangents(const std::array<Vec3, 4>& corners, int point) {
    constexpr double low = 0.25 * (1 - std::numbers::inv_sqrt3), high = 0.25 * (1 + std::numbers::inv_sqrt3);
    const Vec3 a0 = corners[1] - corners[0], a1 = corners[2] - corners[3];
    const Vec3 b0 = corners[3] - corners[0], b1 = corners[2] - corners[1];
    const bool is_late_s = point >= 2, is_late_t = point % 2 == 1;
    a = is_late_t ? low * a0 + high * a1 : high * a0 + low * a1;
    b = is_late_s ? low * b0 + high * b1 : high * b0 + low * b1;
    n = a.cross(b);
  }

  // Factors s, t of s a + t b, the vector of their plane that has the same products with both.
  [[nodiscard]] std::array<double, 2> factors(const Vec3& vector) const {
    return {vector.cross(b).dot(n) / n.squaredNorm(), a.cross(vector).dot(n) / n.squaredNorm()};
  }
};

// Second moments of the area of a polygon about its centre, over its triangles from there; any factor.
Mat3 second_moments(std::span<const Vec3> corners) {
  Vec3 middle = Vec3::Zero(), first = Vec3::Zero();
  for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
  Mat3 second = Mat3::Zero();
  double area = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = corners[i] - middle, b = corners[(i + 1) % corners.size()] - middle, both = a + b;
    const double part = a.cross(b).norm();
    second += part / 12 * (a * a.transpose() + b * b.transpose() + both * both.transpose());
    first += part / 3 * both;
    area += part;
  }
  return area > 0 ? Mat3(second - first * first.transpose() / area) : Mat3::Zero();
}

}  // namespace

void write_fibres(const FibreRule& rule, const Face& face, bool is_apical, const std::array<Vec3, 4>& corners,
                  FibreBatch& batch, std::size_t place) {
  const double of_cell = rule.angles_deg.empty() ? 0 : rule.angles_deg[face.cell.index()];
  const double angle = (rule.angle_deg + of_cell) * std::numbers::pi / 180;
  for (int point = 0; point < 4; ++point) {
    const Tangents at(corners, point);
    const Vec3 up = (is_apical ? 1 : -1) * at.n.normalized();
    const Vec3 axis = Vec3::UnitX() - up.x() * up;
    const bool has_axis = axis.squaredNorm() > least_in_surface;
    const Vec3 along = has_axis ? axis.normalized() : Vec3(Vec3::Zero());
    const auto [s, t] = at.factors(std::cos(angle) * along + std::sin(angle) * up.cross(along));
    batch.s[point][place] = s;
    batch.t[point][place] = t;
    batch.of_area[point][place] = has_axis ? 1 - rule.share : 1 - 0.5 * rule.share;
    batch.of_length[point][place] = has_axis ? rule.share * at.n.norm() : 0;
  }
}

CellAxes::CellAxes(const Tissue& tissue, CellSide side, FibreAxis axis) {
  for (const Cell& cell : tissue.cells) {
    const auto corners = side == CellSide::apical ? cell.apical_corners() : cell.basal_corners();
    const std::span<const Vec3> rest(cell.rest_shape);
    polygons_.emplace_back(corners.begin(), corners.end());
    if (axis == FibreAxis::stretch)
      gradients_.push_back(
          mean_gradient(side == CellSide::apical ? rest.last(cell.sides()) : rest.first(cell.sides())));
  }
}

CellAxes::Axis CellAxes::of(CellId cell, std::span<const Vec3> positions) const {
  const std::vector<NodeId>& polygon = polygons_[cell.index()];
  Mat3 squares;
  if (gradients_.empty()) {
    Vectors corners;
    for (const NodeId node : polygon) corners.push_back(positions[node.index()]);
    squares = second_moments(corners);
  } else {
    Eigen::Matrix<double, 3, 2> stretch = Eigen::Matrix<double, 3, 2>::Zero();
    for (std::size_t i = 0; i < polygon.size(); ++i)
      stretch += positions[polygon[i].index()] * gradients_[cell.index()][i];
    squares = stretch * stretch.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> principal(squares);
  const double least = principal.eigenvalues()[1], most = principal.eigenvalues()[2];
  return {principal.eigenvectors().col(2), most > 0 ? (most - least) / (most + least) : 0};
}

void write_fibres(double share, const CellAxes::Axis& axis, const std::array<Vec3, 4>& rest_corners,
                  const std::array<Vec3, 4>& corners, FibreBatch& batch, std::size_t place) {
  for (int point = 0; point < 4; ++point) {
    const Tangents rest(rest_corners, point), now(corners, point);
    const double facing = now.n.squaredNorm() > 0 ? 1 - std::pow(axis.direction.dot(now.n.normalized()), 2) : 0;
    const auto [s, t] = facing > least_in_surface ? now.factors(axis.direction) : std::array{0.0, 0.0};
    const double length = (s * rest.a + t * rest.b).norm();
    const double its = length > 0 ? share * axis.anisotropy : 0;
    batch.s[point][place] = length > 0 ? s / length : 0;
    batch.t[point][place] = length > 0 ? t / length : 0;
    batch.of_area[point][place] = 1 - its;
    batch.of_length[point][place] = its * rest.n.norm();
  }
}

}  // namespace plica
