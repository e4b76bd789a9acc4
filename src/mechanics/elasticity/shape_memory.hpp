// Discrete shape-memory elasticity (section 2.2 of the paper; docs/theory/shape_memory.md).
//
// Each node of an element is pulled to its place in the rest-shape attractor, the rest shape moved as a rigid body with
// the element: f_i = -(P + k l) d_i / l with d_i = x_i - (c + R (X_i - C)) and l = |d_i|. R is the rotation that
// fits best (least sum |d_i|^2): spring forces then have no torque and derive from sum k l^2 / 2.
#pragma once

#include "mechanics/derivatives.hpp"
#include "mechanics/elasticity/turning_elements.hpp"

namespace plica {

/// Springs from nodes to their places in the attractor, with tension P l / sqrt(l^2 + e^2) + k l.
struct AttractorSprings {
  double stiffness = 0;       // k, nN/um; 0: from the shear modulus of each element
  double shear_modulus = 0;   // kPa; used if stiffness is 0
  double preload = 0;         // P >= 0, nN
  double preload_length = 1;  // e > 0, um: at this distance the pull is P / sqrt(2)
};

/// Moduli of an element for small uniform strain, in the principal axes of its nodes (edges of a brick), kPa.
struct AttractorModuli {
  Vec3 uniaxial;  // stress / strain along each axis; no stress along the others
  Vec3 shear;     // planes yz, zx, xy
  /// Return the mean over all directions (Voigt); for a cube the shear modulus.
  [[nodiscard]] double mean_shear() const { return (uniaxial.sum() + 3 * shear.sum()) / 15; }
};

/// Return the moduli of a rest shape with springs of `stiffness` (nN/um) and no pre-tension. For a brick a x b x c the
/// uniaxial modulus along a is 2 k a / (b c), the shear modulus in the plane of a and b is 2 k a b / (c (a^2 + b^2)).
AttractorModuli attractor_moduli(const HexPoints& rest, double stiffness);

class ShapeMemory final : public TurningElements, public LawDerivatives {
 public:
  /// Make the law; `shear_viscosity` in nN s/um^2 (0: none), as in Corotational. Given stiffness and pre-tension are
  /// those of a cell of one element; an element that is a fraction v of the cell volume has k v^(1/3) and P v^(2/3),
  /// which preserves moduli and stresses. Throws std::domain_error if a rest shape is inverted.
  ShapeMemory(const Tissue& tissue, const AttractorSprings& springs, double shear_viscosity);

  [[nodiscard]] std::string_view name() const override { return "shape memory"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<ShapeMemory>(*this); }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;

  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override {
    if (shear_viscosity_ > 0) add_viscous_gradient(*this, step, adjoint, gradient);
  }

  /// Return k of each element, nN/um.
  [[nodiscard]] const std::vector<double>& stiffness() const { return stiffness_; }

 protected:
  double respond(std::size_t element, const Vec24& u, Vec24& q) const override;
  const Mat24& local_stiffness(std::size_t element, const Vec24& u, Mat24& space) const override;

 private:
  void fit(const Tissue& tissue, std::size_t element) override;

  AttractorSprings springs_;
  double shear_viscosity_;
  std::vector<double> stiffness_;  // elements; k, nN/um
  std::vector<double> preload_;    // elements; P, nN
};

}  // namespace plica
