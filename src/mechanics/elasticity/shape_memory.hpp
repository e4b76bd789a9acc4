// Discrete shape-memory elasticity (section 2.2 of the paper; docs/theory/shape_memory.md).
//
// Every node of an element is drawn to its place in the rest-shape attractor, the rest shape that follows the element
// as a rigid body: f_i = -(P + k l) d_i / l with d_i = x_i - (c + R (X_i - C)) and l = |d_i|. R is the rotation that
// fits best, sum |d_i|^2 least: then forces along the springs alone have no torque, and derive from sum k l^2 / 2.
#pragma once

#include "mechanics/elasticity/turning_elements.hpp"

namespace plica {

/// The springs from nodes to their places in the attractor. The tension of one is P l / sqrt(l^2 + e^2) + k l.
struct AttractorSprings {
  double stiffness = 0;       // k, nN/um; 0: each element's from the shear modulus
  double shear_modulus = 0;   // kPa; used when no stiffness is given
  double preload = 0;         // P >= 0, nN
  double preload_length = 1;  // e > 0, um: a node this far off is pulled back with P / sqrt(2)
};

/// How an element resists uniform small strain, in the principal axes of its nodes' spread (a brick's edges), kPa.
struct AttractorModuli {
  Vec3 uniaxial;  // stress over strain along each axis; it gives no stress along the others
  Vec3 shear;     // of the planes yz, zx, xy
  /// The mean over all directions (Voigt); on a cube the shear modulus itself.
  [[nodiscard]] double mean_shear() const { return (uniaxial.sum() + 3 * shear.sum()) / 15; }
};

/// The moduli of a rest shape whose nodes have springs of `stiffness` (nN/um) and no preload. For a brick a x b x c the
/// uniaxial one along a is 2 k a / (b c), the shear one in the plane of a and b is 2 k a b / (c (a^2 + b^2)).
AttractorModuli attractor_moduli(const HexPoints& rest, double stiffness);

class ShapeMemory final : public TurningElements {
 public:
  /// `shear_viscosity` in nN s/um^2 (0: none), as in Corotational. A stiffness and a preload that are given are those
  /// of a cell of one element; an element that is a part v of its cell's volume has k v^(1/3) and P v^(2/3), which
  /// keeps moduli and stresses. Throws std::domain_error when a rest shape is inverted.
  ShapeMemory(const Tissue& tissue, const AttractorSprings& springs, double shear_viscosity);

  [[nodiscard]] std::string_view name() const override { return "shape memory"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<ShapeMemory>(*this); }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;

  /// k of each element, nN/um.
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
