// Inversion barrier: an energy that prevents inversion of element corners (docs/theory/corner_barrier.md).
//
// Elastic energies are integrated at Gauss points, so a corner may invert unnoticed. With the corner Jacobian J (triple
// product of its edges), its reference value J_0 and r = J / (threshold J_0), each corner has
//   E = -k V_0/8 (r - 1)^2 ln r   where r < 1, and nothing above,
// V_0 the reference volume of the element: twice continuously differentiable, convex in r, infinite at J = 0.
#pragma once

#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Inversion barrier law. Its semidefinite tangent omits the change of the gradient of a corner.
class CornerBarrier final : public Law {
 public:
  /// Make the law with `modulus` k, kPa; `threshold` is the fraction of the reference Jacobian below which a corner is
  /// repelled.
  CornerBarrier(const Tissue& tissue, double modulus, double threshold = 0.15);

  [[nodiscard]] std::string_view name() const override { return "corner barrier"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<CornerBarrier>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] const LawDerivatives& derivatives() const override { return static_derivatives(); }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;

 private:
  struct Corner;  // corner below the threshold, at given positions
  template <class Take>
  void for_pushed(std::span<const Vec3> positions, std::size_t element, const Take& take) const;
  void fit(const Tissue& tissue, std::size_t element) override;

  double modulus_, threshold_;
  ElementChunks chunks_;
  std::vector<std::array<NodeId, 8>> elements_;
  std::vector<std::array<double, 8>> scales_;  // elements, corners; 1/um^3: r over the triple product of edges
  std::vector<double> rest_volumes_;           // elements; um^3
};

}  // namespace plica
