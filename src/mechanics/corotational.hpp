// Corotational elasticity and Kelvin-Voigt shear viscosity of hexahedral elements.
//
// Linear elasticity in each element's own rotating frame (docs/theory/corotational.md): with R the rotation of the mean
// deformation gradient F = sum_i x_i b_i^T, local displacement u_i = R^T (x_i - c) - (X_i - C) and energy u^T K u / 2.
// K is the 24 x 24 stiffness of the rest shape with nine incompatible modes (Wilson-Taylor) condensed, less its mean
// volumetric part, which belongs to cell_volume. R is differentiated too: the force is the exact gradient, so angular
// momentum is exact and the tangent symmetric. The semidefinite tangent leaves the derivative of R out: R K R^T, the
// warped stiffness.
#pragma once

#include "mechanics/turning_elements.hpp"

namespace plica {

/// Isotropic linear elasticity. Stress = 2 G strain + lambda trace(strain) I, in kPa (nN/um^2).
struct ElasticModuli {
  double lame_lambda = 0;
  double shear_modulus = 0;
  [[nodiscard]] double bulk_modulus() const { return lame_lambda + 2 * shear_modulus / 3; }
  /// From Young's modulus (same unit as the result) and Poisson's ratio in (-1, 1/2).
  static ElasticModuli from_young(double young_modulus, double poisson_ratio);
};

/// The stiffness of one rest shape: 24 x 24, node by node, nN/um; nine incompatible modes condensed. Kept is the mean
/// volumetric part. Exactly zero on rigid translations and small rotations; exact on constant strain (patch test).
/// Source: Taylor, Beresford, Wilson 1976 for the correction of the modes.
Mat24 incompatible_stiffness(const HexPoints& rest, const ElasticModuli& moduli);

/// The moduli (nN s/um^2) of a viscosity that resists shear only: deviatoric. Their stiffness is a damping.
ElasticModuli viscous_moduli(double shear_viscosity);

class Corotational final : public TurningElements {
 public:
  /// `shear_viscosity` in nN s/um^2 (0: none). Rest shapes are those of the tissue's elements. Throws std::domain_error
  /// when a rest shape is inverted.
  Corotational(const Tissue& tissue, const ElasticModuli& moduli, double shear_viscosity);

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;

 protected:
  double respond(std::size_t element, const Vec24& u, Vec24& q) const override;
  const Mat24& local_stiffness(std::size_t element, const Vec24& u, Mat24& space) const override;

 private:
  void fit(const Tissue& tissue, std::size_t element) override;

  ElasticModuli moduli_;
  double shear_viscosity_;
  std::vector<Mat24> stiffness_;  // elements; without the mean volumetric part
};

}  // namespace plica
