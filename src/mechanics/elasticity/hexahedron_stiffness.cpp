#include "mechanics/elasticity/hexahedron_stiffness.hpp"

#include <cmath>

namespace plica {
namespace {

using Mat8 = Eigen::Matrix<double, 8, 8>;

const std::array<Vec3, 8>& gauss_points() {
  static const std::array<Vec3, 8> points = [] {
    std::array<Vec3, 8> p;
    for (int i = 0; i < 8; ++i) p[i] = hex_reference_nodes[i] / std::sqrt(3.0);
    return p;
  }();
  return points;
}

// The stiffness of displacements sum_a v_a f_a whose functions f_a are combinations of the shape functions,
// f_a = sum_i weights(i, a) N_i; the amplitudes of the incompatible modes follow those of the v_a without force.
template <int n>
Eigen::Matrix<double, 3 * n, 3 * n> condensed_stiffness(const HexPoints& rest, const ElasticModuli& moduli,
                                                        ModeGradients modes,
                                                        const Eigen::Matrix<double, 8, n>& weights) {
  constexpr int all = n + 3;  // the last three: 1 - xi^2, 1 - eta^2, 1 - zeta^2
  // Gradients of the modes, which vanish in the mean over the volume: so a constant strain is exact.
  const Mat3 centre_jacobian = hex_jacobian(rest, Vec3::Zero());
  const Mat3 centre_inverse = centre_jacobian.inverse();
  const double centre_determinant = centre_jacobian.determinant();
  const auto modes_at = [](const Vec3& point, const Mat3& jacobian) -> Mat3 {
    return -2 * jacobian.inverse().transpose() * Mat3(point.asDiagonal());
  };
  Mat3 mean_of_modes = Mat3::Zero();
  if (modes == ModeGradients::by_points) {
    double volume = 0;
    for (const Vec3& point : gauss_points()) {
      const Mat3 jacobian = hex_jacobian(rest, point);
      const double weight = jacobian.determinant();
      volume += weight;
      mean_of_modes += weight * modes_at(point, jacobian);
    }
    mean_of_modes /= volume;
  }
  const double lambda = moduli.lame_lambda, mu = moduli.shear_modulus;

  Eigen::Matrix<double, 3 * all, 3 * all> K = Eigen::Matrix<double, 3 * all, 3 * all>::Zero();
  for (const Vec3& point : gauss_points()) {
    const Mat3 jacobian = hex_jacobian(rest, point);
    const double weight = jacobian.determinant();
    const std::array<Vec3, 8> shape_gradients = hex_shape_gradients(point);
    Eigen::Matrix<double, 3, 8> by_reference;
    for (int i = 0; i < 8; ++i) by_reference.col(i) = shape_gradients[i];
    Eigen::Matrix<double, 3, all> g;
    g.template leftCols<n>() = jacobian.inverse().transpose() * (by_reference * weights);
    if (modes == ModeGradients::by_points)
      g.template rightCols<3>() = modes_at(point, jacobian) - mean_of_modes;
    else
      g.template rightCols<3>() =
          -2 * centre_determinant / weight * centre_inverse.transpose() * Mat3(point.asDiagonal());
    // Isotropic: the block of functions a and b is lambda g_a g_b^T + mu (g_b g_a^T + g_a . g_b I).
    for (int b = 0; b < all; ++b)
      for (int a = b; a < all; ++a) {
        const Mat3 product = weight * g.col(a) * g.col(b).transpose();
        K.template block<3, 3>(3 * a, 3 * b) +=
            lambda * product + mu * (product.transpose() + product.trace() * Mat3::Identity());
      }
  }
  for (int b = 0; b < all; ++b)
    for (int a = 0; a < b; ++a) K.template block<3, 3>(3 * a, 3 * b) = K.template block<3, 3>(3 * b, 3 * a).transpose();
  const Eigen::Matrix<double, 9, 3 * n> mixed = K.template bottomLeftCorner<9, 3 * n>();
  const Eigen::Matrix<double, 9, 9> of_modes = K.template bottomRightCorner<9, 9>();
  const Eigen::Matrix<double, 3 * n, 3 * n> stiffness =
      K.template topLeftCorner<3 * n, 3 * n>() - mixed.transpose() * of_modes.ldlt().solve(mixed);
  return 0.5 * (stiffness + stiffness.transpose());
}

}  // namespace

ElasticModuli ElasticModuli::from_young(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          young_modulus / (2 * (1 + poisson_ratio))};
}

ElasticModuli viscous_moduli(double shear_viscosity) { return {-2 * shear_viscosity / 3, shear_viscosity}; }

std::array<Vec3, 8> mean_gradients(const HexPoints& rest) {
  std::array<Vec3, 8> gradients = hex_volume_gradient(rest);
  const double volume = hex_volume(rest);
  for (Vec3& gradient : gradients) gradient /= volume;
  return gradients;
}

Mat24 incompatible_stiffness(const HexPoints& rest, const ElasticModuli& moduli, ModeGradients modes) {
  return condensed_stiffness<8>(rest, moduli, modes, Mat8::Identity());
}

const std::array<std::array<double, 8>, 7> hex_modes = {{{-1, 1, 1, -1, -1, 1, 1, -1},
                                                         {-1, -1, 1, 1, -1, -1, 1, 1},
                                                         {-1, -1, -1, -1, 1, 1, 1, 1},
                                                         {1, -1, 1, -1, 1, -1, 1, -1},
                                                         {1, 1, -1, -1, -1, -1, 1, 1},
                                                         {1, -1, -1, 1, -1, 1, 1, -1},
                                                         {-1, 1, -1, 1, 1, -1, 1, -1}}};

Mat12 hourglass_stiffness(const HexPoints& rest, const ElasticModuli& moduli, ModeGradients modes) {
  // Displacements with one hourglass amplitude of 1 and no other, no mean and no mean gradient: the last columns of the
  // inverse of what measures these.
  const std::array<Vec3, 8> b = mean_gradients(rest);
  Mat8 measures;
  for (int i = 0; i < 8; ++i) {
    measures(0, i) = 1;
    for (int axis = 0; axis < 3; ++axis) measures(1 + axis, i) = b[i][axis];
  }
  for (int a = 0; a < 4; ++a) {
    Vec3 X = Vec3::Zero();
    for (int i = 0; i < 8; ++i) X += hex_modes[3 + a][i] * rest[i];
    for (int i = 0; i < 8; ++i) measures(4 + a, i) = hex_modes[3 + a][i] - b[i].dot(X);
  }
  return condensed_stiffness<4>(rest, moduli, modes, measures.inverse().rightCols<4>());
}

}  // namespace plica
