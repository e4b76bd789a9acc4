// Neo-Hookean elasticity of hexahedral elements with optional Maxwell relaxation (docs/theory/neo_hookean.md).
//
// At the 2 x 2 x 2 Gauss points, with F the deformation gradient, C = F^T F, J = det F,
//   energy = sum w mu/2 (tr(C C_p^-1) - 3 - 2 ln J),
// infinite where a point is inverted. C_p describes the relaxed rest shape (Maxwell): det C_p = 1, and
//   dC_p/dt = (C - tr(C C_p^-1)/3 C_p)/tau.
// The bulk modulus of this energy is 2 mu/3; the rest of volume elasticity belongs to cell_volume.
#pragma once

#include "mechanics/derivatives.hpp"
#include "mechanics/elasticity/element_values.hpp"
#include "mechanics/kernels/batch_law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct NeoHookeanMaterial {
  double shear_modulus = 0;  // mu, kPa
  double relaxation_s = 0;   // tau; 0: no relaxation
};

/// Neo-Hookean law. Its semidefinite tangent keeps the relaxed rest shape fixed, and is stiffened along rotations of
/// Gauss points under pressure, just enough to prevent negative stiffness.
class NeoHookean final : public BatchLaw<NeoHookean, 8>, public LawDerivatives {
 public:
  /// Make the law; `materials` per element, rest shapes of the elements of the tissue. Throws std::domain_error if one
  /// is inverted.
  NeoHookean(const Tissue& tissue, std::vector<NeoHookeanMaterial> materials, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override;

  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override;
  void add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                             std::span<Vec3> positions, const BeginningGradient& gradient) const override;
  /// Strengths are shear moduli.
  void add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                             std::span<double> of_cells) const override;
  [[nodiscard]] std::unique_ptr<Law> with_strengths(std::span<const double> factors) const override;

  /// Return, if cells relax, C_p at the beginning of this step, then of the previous step, in the layout of kernels.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;

  /// Return materials after a division; daughters inherit modulus and relaxation, and each Gauss point the C_p of the
  /// nearest Gauss point of the mother in the reference state. Remeshed cells have not flowed from their rest shapes.
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                          const TissueChange& change,
                                                          const ChangePositions&) const override;

  [[nodiscard]] std::optional<Mat3> elastic_stretch(std::span<const double> internal, std::span<const Vec3> positions,
                                                    std::span<const ElementId> elements) const override;

  void add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const override;

  /// Return C_p of a Gauss point in an internal state.
  [[nodiscard]] Mat3 flowed(std::span<const double> internal, ElementId element, int gauss_point) const;

 private:
  friend BatchLaw;
  static constexpr std::array tables = {&generic::neo_hookean_kernels, &avx2::neo_hookean_kernels,
                                        &avx512::neo_hookean_kernels};
  void fit(const Tissue& tissue, std::size_t element) override;
  // An internal state: batches at the beginning of this step, and of the previous step.
  struct Memory {
    std::span<const FlowedBatch> now, earlier;
  };
  [[nodiscard]] Memory memory(std::span<const double> internal) const;
  // Sums over Gauss points of elements: weights, and weights times the left Cauchy-Green tensor of the elastic strain.
  struct Stretches {
    double weights = 0;
    Mat3 sum = Mat3::Zero();
  };
  void add_stretches(std::span<const double> internal, std::span<const Vec3> positions, ElementId element,
                     Stretches& stretches) const;
  [[nodiscard]] Mat3 flowed_before(std::size_t element, int gauss_point, const Step& step) const;
  [[nodiscard]] NeoHookeanArrays kernel_arrays(const Step& step) const;
  // A Gauss point at the end of a step: F, the inverse of dx/d(reference) at rest, C_b + r C and r. `place`: the
  // element, or a repetition of the last.
  struct FlowingPoint {
    Mat3 F, to_rest, sum;
    double r;
  };
  [[nodiscard]] FlowingPoint flowing_point(std::size_t place, int gauss_point, const Step& step) const;
  // Add the gradient by C_b to that by an internal state.
  void add_by_flowed(const Mat3& by_flowed, std::size_t place, int gauss_point,
                     const BeginningGradient& gradient) const;

  ElementValues<NeoHookeanMaterial> materials_;
  std::vector<double> strengths_;  // cells; factors on shear moduli; empty: 1
  bool flows_;                     // whether any element relaxes
  std::vector<CellId> element_cell_;
  std::vector<HexPoints> rest_;  // elements; um
  std::vector<NeoHookeanBatch> batches_;
  std::vector<FlowBatch> flow_batches_;  // if cells relax
};

}  // namespace plica
