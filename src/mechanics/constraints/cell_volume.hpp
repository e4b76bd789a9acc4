// Volume: exactly held per cell by a multiplier, and resisted per element where it varies within a cell.
// Theory: docs/theory/cell_volume.md.
#pragma once

#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "mechanics/kernels/element_chunks.hpp"
#include "mechanics/kernels/kernels.hpp"
#include "mechanics/kernels/volume_kernels.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Elements whose volume matters, eight side by side, and the way through them.
class VolumeElements {
 public:
  VolumeElements(const Tissue& tissue, Kernels kernels);
  void take_rest_shapes(const Tissue& tissue, std::span<const ElementId> elements);

  [[nodiscard]] const VolumeKernels& kernels() const;
  [[nodiscard]] const ElementChunks& chunks() const { return chunks_; }
  [[nodiscard]] const VolumeBatch* batches() const { return batches_.data(); }
  [[nodiscard]] double rest_volume(std::size_t element) const {
    return batches_[element / 8].rest_volumes[element % 8];
  }

 private:
  void fit(const Tissue& tissue, std::size_t element);

  Kernels kernels_;
  ElementChunks chunks_;
  std::vector<VolumeBatch> batches_;
};

/// The constraints V_c(x) = target, one a cell. Their multipliers are the cells' pressures, kPa, positive in
/// compression.
class CellVolumes {
 public:
  /// Targets are the cells' rest volumes.
  explicit CellVolumes(const Tissue& tissue, Kernels kernels = chosen_kernels());

  [[nodiscard]] std::size_t count() const { return targets_.size(); }
  [[nodiscard]] const std::vector<double>& targets() const { return targets_; }
  void set_target(CellId cell, double volume) { targets_[cell.index()] = volume; }

  /// V_c at the given positions, um^3; cells.
  [[nodiscard]] std::vector<double> volumes(std::span<const Vec3> positions) const;
  void volumes(std::span<const Vec3> positions, std::span<double> of_cells) const;

  /// V_c / target - 1; cells.
  [[nodiscard]] std::vector<double> relative_errors(std::span<const Vec3> positions) const;

  /// dV/dx of every element, um^2; elements, in the order of their nodes.
  [[nodiscard]] UninitialisedVector<std::array<Vec3, 8>> element_gradients(std::span<const Vec3> positions) const;
  void element_gradients(std::span<const Vec3> positions, std::span<std::array<Vec3, 8>> gradients) const;

  /// Adds sum_c pressure_c dV_c/dx.
  void add_forces(std::span<const Vec3> positions, std::span<const double> pressures, std::span<Vec3> forces) const;

  /// Adds -sum_c pressure_c d2V_c/dx2 times `direction`.
  void add_tangent_product(std::span<const Vec3> positions, std::span<const double> pressures,
                           std::span<const Vec3> direction, std::span<Vec3> product) const;

  /// Adds -sum_c pressure_c d2V_c/dx2.
  void add_tangent(std::span<const Vec3> positions, std::span<const double> pressures, TangentSink& tangent) const;

  [[nodiscard]] const std::vector<std::array<NodeId, 8>>& elements() const { return elements_; }
  /// Calls body(element) for every element; with `shared`, for elements that have no node in common at once.
  template <class Body>
  void for_elements(const Body& body, bool shared) const {
    volumes_.chunks().for_elements(body, shared);
  }

  [[nodiscard]] CellId cell_of(std::size_t element) const { return element_cell_[element]; }

  /// What the kernels are given.
  [[nodiscard]] VolumeStep kernel_step(std::span<const Vec3> positions, std::span<const double> pressures) const;

 private:
  std::vector<std::array<NodeId, 8>> elements_;
  std::vector<CellId> element_cell_;
  std::vector<double> targets_;  // cells; um^3
  VolumeElements volumes_;
};

/// The bulk modulus at work: energy kappa V0 (V/V0 - 1)^2 / 2 an element, with exact volumes. It replaces the mean
/// volumetric part that Corotational leaves out. Where a cell is one element of exact volume it is zero; within a cell
/// of several it resists one element growing at another's cost; without the constraint it is the whole volume
/// elasticity. Its semidefinite tangent leaves out the pressure times d2V/dx2.
class Dilatation final : public Law {
 public:
  /// `bulk_modulus` in kPa. With `cells_are_exact` (cells' volumes are held) it is left out while every cell is one
  /// element.
  Dilatation(const Tissue& tissue, double bulk_modulus, bool cells_are_exact = false,
             Kernels kernels = chosen_kernels());

  [[nodiscard]] std::string_view name() const override { return "dilatation"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Dilatation>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] NodeGroups node_groups(std::span<const double> internal) const override;
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  void take_rest_shapes(const Tissue& tissue, std::span<const ElementId> elements) override;

 private:
  [[nodiscard]] VolumeStep kernel_step(const Step& step) const;

  std::vector<std::array<NodeId, 8>> elements_;  // none while it is left out
  double bulk_modulus_;
  bool cells_are_exact_;
  Kernels kernels_;
  VolumeElements volumes_;
};

}  // namespace plica
