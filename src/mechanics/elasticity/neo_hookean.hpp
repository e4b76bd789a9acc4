// Neo-Hookean elasticity of hexahedral elements, whose rest shapes may flow (docs/theory/neo_hookean.md).
//
// At the 2 x 2 x 2 Gauss points, with F the deformation gradient, C = F^T F, J = det F,
//   energy = sum w mu/2 (tr(C C_p^-1) - 3 - 2 ln J),
// infinite where a point is inside out. C_p says how the rest shape has flowed (Maxwell): det C_p = 1, and
//   dC_p/dt = (C - tr(C C_p^-1)/3 C_p)/tau.
// A change of volume meets 2 mu/3 only; the rest belongs to cell_volume.
#pragma once

#include "mechanics/elasticity/of_elements.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/kernels.hpp"
#include "mechanics/kernels/neo_hookean_kernels.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// What an element is made of.
struct NeoHookeanMaterial {
  double shear_modulus = 0;  // mu, kPa
  double relaxation_s = 0;   // tau; 0: it does not flow
};

/// Its semidefinite tangent has the flowed rest shape stand still, and is stiffer along rotations of a Gauss point that
/// is under pressure: by as much as keeps any direction from negative stiffness.
class NeoHookean final : public Law {
 public:
  /// `materials` of elements. Rest shapes are those of the tissue's elements. Throws std::domain_error when one is
  /// inverted.
  NeoHookean(const Tissue& tissue, std::vector<NeoHookeanMaterial> materials, Kernels kernels = chosen_kernels());
  /// `shear_moduli` of the cells; `relaxation_s` of the cells, none at all when no cell flows.
  NeoHookean(const Tissue& tissue, const std::vector<double>& shear_moduli,
             const std::vector<double>& relaxation_s = {}, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "elasticity"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<NeoHookean>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;

  /// Where cells flow: C_p at the beginning of the step, then that at the beginning of the step before, as kernels take
  /// them.
  [[nodiscard]] std::vector<double> first_internal(const Tissue& tissue) const override;
  [[nodiscard]] std::vector<double> next_internal(const Step& step) const override;

  /// Daughters have their mother's modulus and relaxation; a Gauss point has the C_p of that of its mother which was
  /// nearest at rest.
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::vector<double> internal_after_division(std::span<const double> internal, const Tissue& tissue,
                                                            const Division& division) const override;
  void take_rest_shapes(const Tissue& tissue, std::span<const ElementId> elements) override;

  /// C_p of a Gauss point in an internal state.
  [[nodiscard]] Mat3 flowed(std::span<const double> internal, ElementId element, int gauss_point) const;

 private:
  void fit(const Tissue& tissue, std::size_t element);  // makes what is kept of it from its rest shape
  [[nodiscard]] bool flows() const { return flows_; }
  [[nodiscard]] Mat3 flowed_before(std::size_t element, int gauss_point, const Step& step) const;
  [[nodiscard]] NeoHookeanStep kernel_step(const Step& step) const;
  [[nodiscard]] const NeoHookeanKernels& kernels() const;

  OfElements<NeoHookeanMaterial> materials_;
  bool flows_;  // whether any does
  Kernels kernels_;
  std::vector<std::array<NodeId, 8>> elements_;
  std::vector<CellId> element_cell_;
  std::vector<HexPoints> rest_;  // elements; um
  ElementChunks chunks_;
  std::vector<NeoHookeanBatch> batches_;
  std::vector<FlowBatch> flow_batches_;  // where cells flow
};

}  // namespace plica
