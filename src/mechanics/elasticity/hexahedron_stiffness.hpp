// The stiffness of a hexahedral element in its rest frame: nine incompatible modes condensed
// (docs/theory/corotational.md, Stiffness and Modes).
#pragma once

#include <Eigen/Dense>

#include "tissue/hexahedron.hpp"

namespace plica {

using Mat24 = Eigen::Matrix<double, 24, 24>;
using Mat12 = Eigen::Matrix<double, 12, 12>;
using Vec24 = Eigen::Matrix<double, 24, 1>;

/// Isotropic linear elasticity. Stress = 2 G strain + lambda trace(strain) I, in kPa (nN/um^2).
struct ElasticModuli {
  double lame_lambda = 0;
  double shear_modulus = 0;
  [[nodiscard]] double bulk_modulus() const { return lame_lambda + 2 * shear_modulus / 3; }
  /// Convert from Young's modulus (same unit as the result) and Poisson's ratio in (-1, 1/2).
  static ElasticModuli from_young(double young_modulus, double poisson_ratio);
};
inline ElasticModuli operator*(double factor, const ElasticModuli& moduli) {
  return {factor * moduli.lame_lambda, factor * moduli.shear_modulus};
}

/// Return moduli (nN s/um^2) of a viscosity that resists shear only (deviatoric), as a damping stiffness.
ElasticModuli viscous_moduli(double shear_viscosity);

/// Return mean gradients b_i of the shape functions over the reference volume, 1/um: mean deformation gradient F = sum
/// x_i b_i^T.
std::array<Vec3, 8> mean_gradients(const HexPoints& rest);

/// Jacobian for gradients of the incompatible modes: that of the element centre, or that of each point, minus the mean.
/// They differ for elements that are not parallelepipeds: in sheets of polygons the first is 6 to 10 % too stiff in
/// bending at a Poisson's ratio of 0.45, the second correct (patch_test.cpp).
enum class ModeGradients { by_centre, by_points };

/// Return the stiffness of one rest shape: 24 x 24, node by node, nN/um; nine incompatible modes condensed, mean
/// volumetric part included. Zero for translations and small rotations; exact for constant strain (patch test).
/// Correction of the modes: Taylor, Beresford, Wilson 1976.
Mat24 incompatible_stiffness(const HexPoints& rest, const ElasticModuli& moduli,
                             ModeGradients modes = ModeGradients::by_centre);

/// Signs at the nodes of the seven modes of a trilinear hexahedron: xi, eta, zeta, and the four hourglasses xi eta, eta
/// zeta, zeta xi, xi eta zeta; [mode][node]. Together with the constant they are orthogonal.
extern const std::array<std::array<double, 8>, 7> hex_modes;

/// Return the part H of that stiffness that vanishes for linear displacements: 12 x 12, hourglass by hourglass, nN/um.
/// With h_a = sum_i (h_ai - b_i . X_a) u_i, h_ai the signs and X_a = sum_i h_ai X_i, the energy of a displacement u is
/// that of its mean strain and h^T H h / 2.
Mat12 hourglass_stiffness(const HexPoints& rest, const ElasticModuli& moduli,
                          ModeGradients modes = ModeGradients::by_centre);

}  // namespace plica
