// The volume is the sum over the six faces of the signed volume between the bilinear face and the origin. For a face
// with points a b c d, counter-clockwise from outside, that is the mean of its two triangulations,
//   V_face = (det(a,b,c) + det(a,c,d) + det(a,b,d) + det(b,c,d)) / 12      (docs/theory/cell_volume.md),
// so dV_face/da = (b x c + c x d + b x d) / 12, and a turns through the cycle. Over the closed surface the same holds
// with b, c, d taken relative to a, which keeps rounding independent of where the cell lies.
#include "tissue/hexahedron.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

const std::array<Vec3, 8> hex_reference_nodes = {Vec3{-1, -1, -1}, Vec3{1, -1, -1}, Vec3{1, 1, -1}, Vec3{-1, 1, -1},
                                                 Vec3{-1, -1, 1},  Vec3{1, -1, 1},  Vec3{1, 1, 1},  Vec3{-1, 1, 1}};

const std::array<std::array<int, 2>, 12> hex_edges = {
    {{0, 1}, {3, 2}, {4, 5}, {7, 6}, {0, 3}, {1, 2}, {4, 7}, {5, 6}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

const std::array<std::array<int, 4>, 6> hex_faces = {
    {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};

std::array<double, 8> hex_shape(const Vec3& reference) {
  std::array<double, 8> values;
  for (int i = 0; i < 8; ++i) {
    const Vec3 s = hex_reference_nodes[i].cwiseProduct(reference) + Vec3::Ones();
    values[i] = 0.125 * s.x() * s.y() * s.z();
  }
  return values;
}

std::array<Vec3, 8> hex_shape_gradients(const Vec3& reference) {
  std::array<Vec3, 8> gradients;
  for (int i = 0; i < 8; ++i) {
    const Vec3& n = hex_reference_nodes[i];
    const Vec3 s = n.cwiseProduct(reference) + Vec3::Ones();
    gradients[i] = 0.125 * Vec3(n.x() * s.y() * s.z(), s.x() * n.y() * s.z(), s.x() * s.y() * n.z());
  }
  return gradients;
}

HexPoints hex_part(const HexPoints& points, const Vec3& low, const Vec3& high) {
  HexPoints part;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 reference;
    for (int axis = 0; axis < 3; ++axis)
      reference[axis] = 2 * (hex_reference_nodes[corner][axis] > 0 ? high : low)[axis] - 1;
    const std::array<double, 8> shape = hex_shape(reference);
    part[corner].setZero();
    for (int i = 0; i < 8; ++i) part[corner] += shape[i] * points[i];
  }
  return part;
}

Mat3 hex_jacobian(const HexPoints& points, const Vec3& reference) {
  const std::array<Vec3, 8> gradients = hex_shape_gradients(reference);
  Mat3 jacobian = Mat3::Zero();
  for (int i = 0; i < 8; ++i) jacobian += points[i] * gradients[i].transpose();
  return jacobian;
}

double hex_volume(const HexPoints& points) {
  // Points relative to the first: the volume does not change under translation, its rounding does.
  double sum = 0;
  for (const auto& face : hex_faces) {
    const Vec3 a = points[face[0]] - points[0], b = points[face[1]] - points[0], c = points[face[2]] - points[0],
               d = points[face[3]] - points[0];
    // det(a,b,c) + det(a,c,d) + det(a,b,d) + det(b,c,d), with products shared.
    sum += a.dot((b - d).cross(c) + b.cross(d)) + b.dot(c.cross(d));
  }
  return sum / 12;
}

std::array<Vec3, 8> hex_volume_gradient(const HexPoints& points) {
  std::array<Vec3, 8> gradient;
  gradient.fill(Vec3::Zero());
  for (const auto& face : hex_faces) {
    for (int k = 0; k < 4; ++k) {
      const Vec3& a = points[face[k]];
      const Vec3 b = points[face[(k + 1) % 4]] - a;
      const Vec3 c = points[face[(k + 2) % 4]] - a;
      const Vec3 d = points[face[(k + 3) % 4]] - a;
      gradient[face[k]] += ((b - d).cross(c) + b.cross(d)) / 12;
    }
  }
  return gradient;
}

std::array<std::array<Vec3, 8>, 8> hex_volume_hessian(const HexPoints& points) {
  std::array<std::array<Vec3, 8>, 8> hessian;
  for (auto& row : hessian) row.fill(Vec3::Zero());
  // From the gradient: d(b x c)/dc = [b]x and d(b x c)/db = -[c]x. V is linear in each single point: no diagonal
  // blocks.
  for (const auto& face : hex_faces) {
    for (int k = 0; k < 4; ++k) {
      const int ia = face[k], ib = face[(k + 1) % 4], ic = face[(k + 2) % 4], id = face[(k + 3) % 4];
      const Vec3 b = points[ib] - points[ia], c = points[ic] - points[ia], d = points[id] - points[ia];
      hessian[ia][ib] -= (c + d) / 12;
      hessian[ia][ic] += (b - d) / 12;
      hessian[ia][id] += (b + c) / 12;
    }
  }
  return hessian;
}

namespace {

// The edges that meet at each corner, one along each reference direction.
const std::array<std::array<int, 3>, 8>& edges_at_corners() {
  static const auto edges_at = [] {
    std::array<std::array<int, 3>, 8> numbers{};
    for (int e = 0; e < 12; ++e)
      for (const int corner : hex_edges[e]) numbers[corner][e / 4] = e;
    return numbers;
  }();
  return edges_at;
}

}  // namespace

std::array<double, 8> hex_corner_jacobians(const HexPoints& points) {
  std::array<Vec3, 12> edges;
  for (int e = 0; e < 12; ++e) edges[e] = points[hex_edges[e][1]] - points[hex_edges[e][0]];
  std::array<double, 8> jacobians;
  for (int corner = 0; corner < 8; ++corner) {
    const auto& [a, b, c] = edges_at_corners()[corner];
    jacobians[corner] = edges[a].cross(edges[b]).dot(edges[c]) / 8;
  }
  return jacobians;
}

double hex_scaled_jacobian(const HexPoints& points) {
  std::array<Vec3, 12> edges;
  std::array<double, 12> squared_lengths;
  for (int e = 0; e < 12; ++e) {
    edges[e] = points[hex_edges[e][1]] - points[hex_edges[e][0]];
    squared_lengths[e] = edges[e].squaredNorm();
  }
  double worst = 1;
  for (const auto& [a, b, c] : edges_at_corners()) {
    const double lengths = std::sqrt(squared_lengths[a] * squared_lengths[b] * squared_lengths[c]);
    worst = std::min(worst, lengths > 0 ? edges[a].cross(edges[b]).dot(edges[c]) / lengths : -1.0);
  }
  return worst;
}

bool hex_is_upright(const HexPoints& p) {
  // Edges along the three axes of the reference cube, by the corners that they join. Named one by one, as below.
  const Vec3 x01 = p[1] - p[0], x32 = p[2] - p[3], x45 = p[5] - p[4], x76 = p[6] - p[7];
  const Vec3 y03 = p[3] - p[0], y12 = p[2] - p[1], y47 = p[7] - p[4], y56 = p[6] - p[5];
  const Vec3 z04 = p[4] - p[0], z15 = p[5] - p[1], z26 = p[6] - p[2], z37 = p[7] - p[3];
  return x01.cross(y03).dot(z04) > 0 && x01.cross(y12).dot(z15) > 0 && x32.cross(y12).dot(z26) > 0 &&
         x32.cross(y03).dot(z37) > 0 && x45.cross(y47).dot(z04) > 0 && x45.cross(y56).dot(z15) > 0 &&
         x76.cross(y56).dot(z26) > 0 && x76.cross(y47).dot(z37) > 0;
}

double facet_area(const std::array<Vec3, 4>& points) {
  const double g = 1 / std::sqrt(3.0);
  const auto along = [&](double t) -> Vec3 {
    return 0.25 * ((1 - t) * (points[1] - points[0]) + (1 + t) * (points[2] - points[3]));
  };
  const auto across = [&](double s) -> Vec3 {
    return 0.25 * ((1 - s) * (points[3] - points[0]) + (1 + s) * (points[2] - points[1]));
  };
  // Named one by one: in a loop over arrays, GCC keeps them in memory and takes three times as long.
  const Vec3 u0 = along(-g), u1 = along(g), v0 = across(-g), v1 = across(g);
  return u0.cross(v0).norm() + u1.cross(v0).norm() + u0.cross(v1).norm() + u1.cross(v1).norm();
}

// At Gauss points (s, t), with a = dx/ds and b = dx/dt, the area is the sum of |a x b|.
std::array<Vec3, 4> facet_area_gradient(const std::array<Vec3, 4>& x) {
  const double g = 1 / std::sqrt(3.0);
  std::array<Vec3, 4> gradient = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  for (const double s : {-g, g})
    for (const double t : {-g, g}) {
      const Vec3 a = 0.25 * ((1 - t) * (x[1] - x[0]) + (1 + t) * (x[2] - x[3]));
      const Vec3 b = 0.25 * ((1 - s) * (x[3] - x[0]) + (1 + s) * (x[2] - x[1]));
      const Vec3 normal = a.cross(b).stableNormalized();
      const Vec3 by_a = 0.25 * b.cross(normal), by_b = 0.25 * normal.cross(a);
      gradient[0] -= (1 - t) * by_a + (1 - s) * by_b;
      gradient[1] += (1 - t) * by_a - (1 + s) * by_b;
      gradient[2] += (1 + t) * by_a + (1 + s) * by_b;
      gradient[3] += (1 - s) * by_b - (1 + t) * by_a;
    }
  return gradient;
}

Vec3 facet_area_vector(const std::array<Vec3, 4>& points) {
  return 0.5 * (points[2] - points[0]).cross(points[3] - points[1]);
}

double largest_face(const HexPoints& points) {
  double area = 0;
  for (const auto& face : hex_faces)
    area = std::max(area, facet_area({points[face[0]], points[face[1]], points[face[2]], points[face[3]]}));
  return area;
}

}  // namespace plica
