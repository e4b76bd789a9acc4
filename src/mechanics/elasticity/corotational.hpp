// Corotational elasticity and Kelvin-Voigt shear viscosity of hexahedral elements.
//
// Linear elasticity in the rotating frame of each element (docs/theory/corotational.md): with R the rotation and S the
// stretch of the mean deformation gradient F = sum_i x_i b_i^T = R S, and h the hourglass modes of
// the local displacement u_i = R^T (x_i - c) - (X_i - C),
//   energy = V0 G |dev(S - I)|^2 + h^T H h / 2.
// That is u^T K u / 2 with K the 24 x 24 stiffness of the rest shape with nine incompatible modes (Wilson-Taylor)
// condensed, minus its mean volumetric part, which belongs to cell_volume. R is differentiated too: the force is the
// exact gradient, so angular momentum is conserved and the tangent symmetric. The semidefinite tangent omits the
// derivative of R: R K R^T, the warped stiffness.
#pragma once

#include "mechanics/elasticity/hexahedron_stiffness.hpp"
#include "mechanics/elasticity/of_elements.hpp"
#include "mechanics/kernels/corotational_kernels.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/kernels.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

class Corotational final : public Law {
 public:
  /// Make the law; `moduli` per element, `shear_viscosity` in nN s/um^2 (0: none), rest shapes of the elements of the
  /// tissue. Throws std::domain_error if a rest shape is inverted.
  Corotational(const Tissue& tissue, std::vector<ElasticModuli> moduli, double shear_viscosity,
               Kernels kernels = chosen_kernels());
  /// Make the law with equal moduli, times the `factors` of cells if given.
  Corotational(const Tissue& tissue, const ElasticModuli& moduli, double shear_viscosity,
               const std::vector<double>& factors = {}, Kernels kernels = chosen_kernels())
      : Corotational(tissue, in_all_elements(tissue, moduli, factors), shear_viscosity, kernels) {}

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Corotational>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements) const override;

  /// Return the input of the kernels.
  [[nodiscard]] CorotationalStep kernel_step(const Step& step) const;

 private:
  void fit(const Tissue& tissue, std::size_t element);  // computes element data from the rest shape
  [[nodiscard]] NodeId node(std::size_t element, int corner) const;
  [[nodiscard]] const CorotationalKernels& kernels() const;

  OfElements<ElasticModuli> moduli_;
  double shear_viscosity_;
  Kernels kernels_;
  ElementChunks chunks_;
  std::vector<CorotationalBatch> batches_;     // eight elements each
  std::vector<ViscousBatch> viscous_batches_;  // viscous counterpart
};

}  // namespace plica
