// Points, directions and small matrices. Units inside plica: micrometre, second, nanonewton; so stress is in kPa.
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace plica {

using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vectors = std::vector<Vec3>;

/// Scalar product of two lists of vectors of equal length, summed in order.
inline double dot(const Vectors& a, const Vectors& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
  return sum;
}

/// Matrix [a]x with [a]x b = a x b.
inline Mat3 cross_matrix(const Vec3& a) {
  Mat3 m;
  m << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return m;
}

}  // namespace plica
