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

#include "mechanics/derivatives.hpp"
#include "mechanics/elasticity/element_values.hpp"
#include "mechanics/elasticity/hexahedron_stiffness.hpp"
#include "mechanics/kernels/batch_law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

class Corotational final : public BatchLaw<Corotational, 8>, public LawDerivatives {
 public:
  /// Make the law; `moduli` per element, `shear_viscosity` in nN s/um^2 (0: none), rest shapes of the elements of the
  /// tissue. Throws std::domain_error if a rest shape is inverted.
  Corotational(const Tissue& tissue, std::vector<ElasticModuli> moduli, double shear_viscosity,
               Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;

  [[nodiscard]] bool overbends() const override { return true; }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override {
    if (shear_viscosity_ > 0) add_viscous_gradient(*this, step, adjoint, gradient);
  }
  /// Strengths are moduli, not viscosities.
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override;
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;

  void add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const override;

  [[nodiscard]] CorotationalArrays kernel_arrays(const Step& step) const;

 private:
  friend BatchLaw;
  static constexpr std::array tables = {&generic::corotational_kernels, &avx2::corotational_kernels,
                                        &avx512::corotational_kernels};
  void fit(const Tissue& tissue, std::size_t element) override;
  [[nodiscard]] std::vector<double> energies(const CorotationalArrays& of_kernels) const;

  ElementValues<ElasticModuli> moduli_;
  std::vector<CellId> element_cell_;
  std::vector<double> strengths_;  // cells; factors on moduli; empty: 1
  double shear_viscosity_;
  std::vector<CorotationalBatch> batches_;     // eight elements each
  std::vector<ViscousBatch> viscous_batches_;  // viscous counterpart
};

}  // namespace plica
