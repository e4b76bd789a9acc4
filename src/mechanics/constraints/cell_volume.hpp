// Cell volume: an equality constraint per cell, and a bulk modulus within cells of several elements. Theory:
// docs/theory/cell_volume.md.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "mechanics/constraint.hpp"
#include "mechanics/elasticity/element_values.hpp"
#include "mechanics/kernels/batch_law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Volume constraints V_c(x) = target, one per cell. Multipliers are cell pressures, kPa, positive in compression.
class CellVolumes final : public Constraint {
 public:
  /// Set targets to the target volumes of cells.
  explicit CellVolumes(const Tissue& tissue, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "cell volumes"; }
  [[nodiscard]] std::unique_ptr<Constraint> clone() const override { return std::make_unique<CellVolumes>(*this); }
  [[nodiscard]] std::size_t count() const override { return targets_.size(); }
  [[nodiscard]] std::span<const double> targets() const override { return targets_; }
  [[nodiscard]] bool is_held() const override { return is_held_; }
  /// Whether steps enforce the constraints; otherwise the projection, a bulk modulus, or nothing does.
  void hold(bool held) { is_held_ = held; }

  /// Return V_c at the given positions, um^3; cells.
  [[nodiscard]] std::vector<double> volumes(std::span<const Vec3> positions) const;
  void values(std::span<const Vec3> positions, std::span<double> of_cells) const override;

  /// Return V_c / target - 1; cells.
  [[nodiscard]] std::vector<double> relative_errors(std::span<const Vec3> positions) const;

  /// Parts of the functions: elements.
  [[nodiscard]] ConstraintParts parts() const override;
  void gradients(std::span<const Vec3> positions, std::span<Vec3> of_elements) const override;
  void for_parts(const std::function<void(std::size_t)>& body, bool shared) const override {
    chunks_.for_elements(body, shared);
  }
  void add_forces(std::span<const Vec3> positions, std::span<const double> pressures,
                  std::span<Vec3> forces) const override;
  void add_tangent_product(std::span<const Vec3> positions, std::span<const double> pressures,
                           std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(std::span<const Vec3> positions, std::span<const double> pressures,
                   TangentSink& tangent) const override;
  /// About the square of a face's area, V^(4/3).
  [[nodiscard]] double gradient_scale(std::size_t cell) const override {
    return std::cbrt(targets_[cell]) * targets_[cell];
  }
  [[nodiscard]] double rounding(const Tissue& tissue, double position_rounding) const override;
  /// Return the constraints of the tissue after growth.
  [[nodiscard]] CellVolumes grown(const Tissue& tissue) const;
  /// Return the constraints after a division; daughters inherit pressures.
  [[nodiscard]] CellVolumes divided(const Tissue& tissue, const TissueChange& change) const;
  [[nodiscard]] std::unique_ptr<Constraint> after_change(const Tissue& tissue, const TissueChange& change,
                                                         std::span<const Vec3> /*positions*/) const override {
    return std::make_unique<CellVolumes>(divided(tissue, change));
  }
  [[nodiscard]] std::vector<double> multipliers_after_division(std::span<const double> pressures,
                                                               const TissueChange& change) const override;

  [[nodiscard]] VolumeArrays kernel_arrays(std::span<const Vec3> positions, std::span<const double> pressures) const;

 private:
  void take_targets(const Tissue& tissue);

  std::vector<std::array<NodeId, 8>> elements_;
  std::vector<CellId> element_cell_;
  std::vector<double> targets_;  // cells; um^3
  ElementChunks chunks_;
  std::vector<VolumeBatch> batches_;
  const VolumeKernels* kernels_;
  bool is_held_ = true;
};

/// Bulk elasticity: energy kappa V0 (V/V0 - 1)^2 / 2 per element, with exact volumes; V0 is the share of the element in
/// the held volume of its cell, else its reference volume. It replaces the mean volumetric part that the elastic laws
/// omit. It is zero if a cell is one element of exact volume; in a cell of several elements it resists volume exchange
/// between them; without the constraint it is the whole volume elasticity. The semidefinite tangent omits the pressure
/// times d2V/dx2.
class Dilatation final : public BatchLaw<Dilatation, 8> {
 public:
  /// Make the law; `bulk_moduli` per element, kPa. With `cells_are_exact` (cell volumes held) it is inactive while
  /// every cell is one element.
  Dilatation(const Tissue& tissue, std::vector<double> bulk_moduli, bool cells_are_exact,
             Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "dilatation"; }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] const LawDerivatives& derivatives() const override { return static_derivatives(); }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> positions) const override;
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements,
                                           std::span<const GrowthTensor> tensors) const override;

 private:
  friend BatchLaw;
  static constexpr std::array tables = {&generic::volume_kernels, &avx2::volume_kernels, &avx512::volume_kernels};
  void fit(const Tissue& tissue, std::size_t place) override;
  void take_target_volumes(const Tissue& tissue);
  [[nodiscard]] VolumeArrays kernel_arrays(const Step& step) const;

  ElementValues<double> bulk_moduli_;  // kPa
  bool cells_are_exact_;
  std::vector<VolumeBatch> batches_;  // empty while inactive, as are the elements
};

}  // namespace plica
