// Laws on single nodes: drag, inertia, and pressure on faces (dead load).
#pragma once

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/law.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Drag on apical and basal faces: force -d v, with d from reference face areas, a quarter of each facet per corner.
class SurfaceDrag final : public Law {
 public:
  /// Make the law with `drag` in nN s/um^3 (1 Pa s/um is 1e-3).
  SurfaceDrag(const Tissue& tissue, double drag);

  [[nodiscard]] std::string_view name() const override { return "drag"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<SurfaceDrag>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements) const override;

 private:
  double drag_;
  std::vector<double> coefficients_;  // nodes; nN s/um
};

/// Inertia with lumped mass, an eighth of each element per corner: backward Euler for M dv/dt.
class Inertia final : public Law {
 public:
  /// Make the law with `density` in g/um^3.
  Inertia(const Tissue& tissue, double density);

  [[nodiscard]] std::string_view name() const override { return "inertia"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<Inertia>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const override;
  void add_tangent(const Step& step, TangentSink& tangent) const override;
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override;
  [[nodiscard]] std::span<const double> masses() const override { return masses_; }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements) const override;

 private:
  double density_;
  std::vector<double> masses_;  // nodes; g
};

/// Pressure on apical or basal facets of some cells, directed into the cell: a dead load on reference faces.
class FacePressure final : public Law {
 public:
  /// Make the law with `pressure` in kPa, times the strengths of cells; delays are ignored.
  FacePressure(const Tissue& tissue, bool on_apical, CellPattern pattern, double pressure, Program program);

  [[nodiscard]] std::string_view name() const override { return "pressure"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<FacePressure>(*this); }
  [[nodiscard]] double energy(const Step& step) const override;
  [[nodiscard]] EnergyFlow energy_flow(const MadeStep& made) const override;
  void add_forces(const Step& step, std::span<Vec3> forces) const override;
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}  // constant force
  void add_tangent(const Step&, TangentSink&) const override {}
  [[nodiscard]] const CellPattern& pattern() const { return pattern_; }
  [[nodiscard]] std::vector<double> program_points_s() const override { return program_.times_s(); }
  [[nodiscard]] std::vector<double> program_jumps_s() const override { return program_.jumps_s(); }
  [[nodiscard]] std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                    std::span<const Vec3> positions) const override;

 private:
  bool on_apical_;
  CellPattern pattern_;
  double pressure_;
  Vectors loads_;  // nodes; nN at activity 1
  Program program_;
};

}  // namespace plica
