#include "mechanics/corotational.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace plica {
namespace {

using Mat6x24 = Eigen::Matrix<double, 6, 24>;
using Mat6x9 = Eigen::Matrix<double, 6, 9>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

const std::array<Vec3, 8>& gauss_points() {
  static const std::array<Vec3, 8> points = [] {
    std::array<Vec3, 8> p;
    for (int i = 0; i < 8; ++i) p[i] = hex_reference_nodes[i] / std::sqrt(3.0);
    return p;
  }();
  return points;
}

// Columns of the strain-displacement matrix for a shape function with gradient g. Strain order: xx yy zz xy yz zx, with
// engineering shears.
Eigen::Matrix<double, 6, 3> strain_columns(const Vec3& g) {
  Eigen::Matrix<double, 6, 3> b = Eigen::Matrix<double, 6, 3>::Zero();
  b(0, 0) = g.x(), b(1, 1) = g.y(), b(2, 2) = g.z();
  b(3, 0) = g.y(), b(3, 1) = g.x();
  b(4, 1) = g.z(), b(4, 2) = g.y();
  b(5, 0) = g.z(), b(5, 2) = g.x();
  return b;
}

Mat6 stress_matrix(const ElasticModuli& moduli) {
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>().setConstant(moduli.lame_lambda);
  for (int i = 0; i < 3; ++i) d(i, i) += 2 * moduli.shear_modulus;
  for (int i = 3; i < 6; ++i) d(i, i) = moduli.shear_modulus;
  return d;
}

}  // namespace

ElasticModuli ElasticModuli::from_young(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          young_modulus / (2 * (1 + poisson_ratio))};
}

ElasticModuli viscous_moduli(double shear_viscosity) { return {-2 * shear_viscosity / 3, shear_viscosity}; }

Mat24 incompatible_stiffness(const HexPoints& rest, const ElasticModuli& moduli) {
  const Mat6 d = stress_matrix(moduli);
  const Mat3 centre_jacobian = hex_jacobian(rest, Vec3::Zero());
  const Mat3 centre_inverse = centre_jacobian.inverse();
  const double centre_determinant = centre_jacobian.determinant();

  Mat24 compatible = Mat24::Zero();
  Eigen::Matrix<double, 9, 24> mixed = Eigen::Matrix<double, 9, 24>::Zero();
  Eigen::Matrix<double, 9, 9> modes = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Vec3& point : gauss_points()) {
    const Mat3 jacobian = hex_jacobian(rest, point);
    const Mat3 inverse = jacobian.inverse();
    const double weight = jacobian.determinant();
    const std::array<Vec3, 8> gradients = hex_shape_gradients(point);
    Mat6x24 b;
    for (int i = 0; i < 8; ++i) b.middleCols<3>(3 * i) = strain_columns(inverse.transpose() * gradients[i]);
    // Modes 1 - xi^2 and so on, their gradients taken with the centre's Jacobian so that they vanish in the mean.
    Mat6x9 m;
    for (int k = 0; k < 3; ++k) {
      const Vec3 local = -2 * point[k] * Vec3::Unit(k);
      m.middleCols<3>(3 * k) = strain_columns((centre_determinant / weight) * (centre_inverse.transpose() * local));
    }
    compatible += weight * b.transpose() * d * b;
    mixed += weight * m.transpose() * d * b;
    modes += weight * m.transpose() * d * m;
  }
  Mat24 stiffness = compatible - mixed.transpose() * modes.ldlt().solve(mixed);
  return 0.5 * (stiffness + stiffness.transpose());
}

Corotational::Corotational(const Tissue& tissue, const ElasticModuli& moduli, double shear_viscosity)
    : TurningElements(tissue, shear_viscosity > 0),
      moduli_(moduli),
      shear_viscosity_(shear_viscosity),
      stiffness_(tissue.elements.size()) {
  parallel_for(elements_.size(), [&](std::size_t e) { fit(tissue, e); });
}

void Corotational::fit(const Tissue& tissue, std::size_t e) {
  const HexPoints& rest = tissue.element_rest_shape[e];
  elements_[e].frame = mean_gradients(rest);
  Vec24 b;
  for (int i = 0; i < 8; ++i) b.segment<3>(3 * i) = elements_[e].frame[i];
  stiffness_[e] = incompatible_stiffness(rest, moduli_) - moduli_.bulk_modulus() * hex_volume(rest) * b * b.transpose();
  if (shear_viscosity_ > 0) elements_[e].viscosity = incompatible_stiffness(rest, viscous_moduli(shear_viscosity_));
}

std::unique_ptr<Law> Corotational::after_division(const Tissue& tissue, const Division&, std::span<const Vec3>) const {
  return std::make_unique<Corotational>(tissue, moduli_, shear_viscosity_);
}

double Corotational::respond(std::size_t element, const Vec24& u, Vec24& q) const {
  q.noalias() = stiffness_[element] * u;
  return 0.5 * u.dot(q);
}

const Mat24& Corotational::local_stiffness(std::size_t element, const Vec24&, Mat24&) const {
  return stiffness_[element];
}

}  // namespace plica
