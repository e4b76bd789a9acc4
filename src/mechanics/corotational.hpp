// Corotational elasticity and Kelvin-Voigt shear viscosity of hexahedral elements.
//
// Linear elasticity in each element's own rotating frame (docs/theory/corotational.md): with R the rotation of the mean
// deformation gradient F = sum_i x_i b_i^T, local displacement u_i = R^T (x_i - c) - (X_i - C) and energy u^T K u / 2.
// K is the 24 x 24 stiffness of the rest shape with nine incompatible modes (Wilson-Taylor) condensed, less its mean
// volumetric part, which belongs to cell_volume. R is differentiated too: the force is the exact gradient, so angular
// momentum is exact and the tangent symmetric. The semidefinite tangent leaves the derivative of R out: R K R^T, the
// warped stiffness.
#pragma once

#include <Eigen/Dense>

#include "mechanics/law.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/tissue.hpp"

namespace plica {

using Mat24 = Eigen::Matrix<double, 24, 24>;
using Vec24 = Eigen::Matrix<double, 24, 1>;

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

/// Mean gradients b_i of the shape functions over the rest volume, 1/um: mean deformation gradient F = sum x_i b_i^T.
std::array<Vec3, 8> mean_gradients(const HexPoints& rest);

class Corotational final : public Law {
 public:
  /// `shear_viscosity` in nN s/um^2 (0: none). Rest shapes are those of the tissue's elements. Throws std::domain_error
  /// when a rest shape is inverted.
  Corotational(const Tissue& tissue, const ElasticModuli& moduli, double shear_viscosity);

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups() const override;

 private:
  struct Element {
    std::array<NodeId, 8> nodes;
    std::array<Vec3, 8> mean_gradient;  // b_i
    HexPoints rest;                     // X_i - C
    Mat24 stiffness;                    // without its mean volumetric part
    Mat24 viscosity;                    // used with shear_viscosity_ > 0 only
  };
  struct Frame;  // an element's rotation, local displacement and local force at given positions

  [[nodiscard]] Frame frame(const Element& element, const Step& step) const;
  void add_warped_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const;

  std::vector<Element> elements_;
  bool viscous_ = false;
};

}  // namespace plica
