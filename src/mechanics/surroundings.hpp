// Laws on single nodes: drag, inertia, and pressure on faces (dead load).
#pragma once

#include <cmath>

#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/active/followed_signal.hpp"
#include "mechanics/active/program.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/energy.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Law that resists displacements d of single nodes: energy sum r/2 |d|^2. `Self` has `dissipates`, remade(tissue) and
/// resist(step, node, take), which calls take(node, r) for nodes that it resists; r, nN/um, is a number or a matrix. It
/// may hide `moved`, as Inertia does. `remade` has the tissue only, also after a division: keep a region by its name.
template <class Self>
class NodeLaw : public Law {
 public:
  [[nodiscard]] std::unique_ptr<Law> clone() const final { return std::make_unique<Self>(self()); }
  [[nodiscard]] double energy(const Step& step) const final {
    double sum = 0;
    for_nodes(step, [&](std::size_t n, const auto& r) { sum += 0.5 * product(r, self().moved(step, n)); });
    return sum;
  }
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const final {
    return Self::dissipates ? viscous_energy_flow(*this, completed) : Law::energy_flow(completed);
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const final {
    for_nodes(step, [&](std::size_t n, const auto& r) { forces[n] -= r * self().moved(step, n); });
  }
  void add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const final {
    for_nodes(step, [&](std::size_t n, const auto& r) { product[n] += r * direction[n]; });
  }
  void add_tangent(const Step& step, TangentSink& tangent) const final {
    for_nodes(step, [&](std::size_t n, const auto& r) { tangent.add_block(NodeId(n), NodeId(n), matrix(r)); });
  }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& /*change*/,
                                                  std::span<const Vec3> /*positions*/) const final {
    return std::make_unique<Self>(self().remade(tissue));
  }
  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId>,
                                           std::span<const GrowthTensor>) const final {
    return std::make_unique<Self>(self().remade(tissue));
  }

 protected:
  /// Return the displacement of a node, um.
  [[nodiscard]] Vec3 moved(const Step& step, std::size_t node) const {
    return step.positions[node] - step.before([node](std::span<const Vec3> x) { return x[node]; });
  }

  /// Add `factor` times the reference areas of facets, a quarter of each per corner.
  void add_areas(const Tissue& tissue, std::span<const Facet> facets, double factor) {
    coefficients_.resize(tissue.node_count());
    for (const Facet& facet : facets) {
      const double of_corner = factor * facet_area(rest_corners(tissue, facet)) / 4;
      for (const NodeId node : facet.nodes) coefficients_[node.index()] += of_corner;
    }
  }

  [[nodiscard]] double norm() const {
    double sum = 0;
    for (const double coefficient : coefficients_) sum += coefficient * coefficient;
    return std::sqrt(sum);
  }

  std::vector<double> coefficients_;  // nodes

 private:
  template <class Take>
  void for_nodes(const Step& step, const Take& take) const {
    for (std::size_t n = 0; n < coefficients_.size(); ++n) self().resist(step, n, take);
  }
  static double product(double r, const Vec3& d) { return r * d.squaredNorm(); }
  static double product(const Mat3& r, const Vec3& d) { return d.dot(r * d); }
  static Mat3 matrix(double r) { return r * Mat3::Identity(); }
  static const Mat3& matrix(const Mat3& r) { return r; }
  [[nodiscard]] const Self& self() const { return static_cast<const Self&>(*this); }
};

/// Drag on apical and basal faces: force -d v, with d from reference face areas, a quarter of each facet per corner.
class SurfaceDrag final : public NodeLaw<SurfaceDrag>, public LawDerivatives {
 public:
  /// Make the law with `drag` in nN s/um^3 (1 Pa s/um is 1e-3).
  SurfaceDrag(const Tissue& tissue, double drag);

  [[nodiscard]] std::string_view name() const override { return "drag"; }
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override {
    return norm() / step.rate_s * position_rounding;
  }
  [[nodiscard]] const LawDerivatives& derivatives() const override { return *this; }
  void add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                          const BeginningGradient& gradient) const override {
    for (std::size_t n = 0; n < coefficients_.size(); ++n)
      gradient.add_before(n, coefficients_[n] / step.rate_s * adjoint[n]);
  }

 private:
  friend NodeLaw;
  static constexpr bool dissipates = true;
  [[nodiscard]] SurfaceDrag remade(const Tissue& tissue) const { return {tissue, drag_}; }
  template <class Take>
  void resist(const Step& step, std::size_t node, const Take& take) const {
    take(node, coefficients_[node] / step.rate_s);
  }

  double drag_;
};

/// Inertia with lumped mass, an eighth of each element per corner: backward Euler for M dv/dt.
class Inertia final : public NodeLaw<Inertia> {
 public:
  /// Make the law with `density` in g/um^3.
  Inertia(const Tissue& tissue, double density);

  [[nodiscard]] std::string_view name() const override { return "inertia"; }
  [[nodiscard]] double rounding(const Step& step, double position_rounding) const override {
    return norm() / (step.rate_s * step.rate_s) * position_rounding;
  }
  [[nodiscard]] std::span<const double> masses() const override { return coefficients_; }

 private:
  friend NodeLaw;
  static constexpr bool dissipates = false;
  [[nodiscard]] Inertia remade(const Tissue& tissue) const { return {tissue, density_}; }
  template <class Take>
  void resist(const Step& step, std::size_t node, const Take& take) const {
    take(node, coefficients_[node] / (step.rate_s * step.rate_s));
  }
  [[nodiscard]] Vec3 moved(const Step& step, std::size_t n) const {
    return step.positions[n] - step.previous_positions[n] - step.rate_s * step.previous_velocities[n];
  }

  double density_;
};

/// Pressure on apical or basal facets of some cells, directed into the cell: a dead load on reference faces.
class FacePressure final : public SignalLaw {
 public:
  /// Make the law with `pressure` in kPa, times the strengths of cells; delays are ignored. `followed`: signal
  /// that scales the pressure.
  FacePressure(const Tissue& tissue, CellSide side, CellPattern pattern, double pressure, Program program,
               FollowedSignal followed = {});

  [[nodiscard]] std::string_view name() const override { return "pressure"; }
  [[nodiscard]] std::unique_ptr<Law> clone() const override { return std::make_unique<FacePressure>(*this); }
  [[nodiscard]] double energy(const Step& step) const override {
    double work = 0;
    for (const Load& load : loads_)
      work += followed_.at(step.internal, load.cell) * load.force.dot(step.positions[load.node]);
    return -program_.at(step.end_time_s) * work;
  }
  [[nodiscard]] EnergyFlow energy_flow(const CompletedStep& completed) const override {
    const Step& step = completed.motion;
    double work = 0;
    for (const Load& load : loads_)
      work += followed_.mean(step.internal, load.cell) *
              load.force.dot(step.positions[load.node] - step.previous_positions[load.node]);
    return {.active = program_.at(step.end_time_s) * work};
  }
  void add_forces(const Step& step, std::span<Vec3> forces) const override {
    const double activity = program_.at(step.end_time_s);
    for (const Load& load : loads_) forces[load.node] += activity * followed_.at(step.internal, load.cell) * load.force;
  }
  void add_tangent_product(const Step&, std::span<const Vec3>, std::span<Vec3>) const override {}  // constant force
  void add_tangent(const Step&, TangentSink&) const override {}
  /// NoGradient where cells follow a signal.
  [[nodiscard]] const LawDerivatives& derivatives() const override {
    if (followed_.is_used()) refuse_gradient("a pressure that follows a signal has no gradient; remove follow");
    return static_derivatives();
  }
  [[nodiscard]] const CellPattern* pattern() const override { return &pattern_; }
  [[nodiscard]] std::vector<double> program_points_s() const override { return program_.times_s(); }
  [[nodiscard]] std::vector<double> program_jumps_s() const override { return program_.jumps_s(); }
  [[nodiscard]] std::unique_ptr<Law> after_change(const Tissue& tissue, const TissueChange& change,
                                                  std::span<const Vec3> /*positions*/) const override {
    return std::make_unique<FacePressure>(tissue, side_, pattern_.after_change(change), pressure_, program_,
                                          followed_.on(tissue));
  }

 private:
  struct Load {  // on a node, nN at activity 1
    std::size_t node = 0;
    CellId cell;  // if it follows a signal; else the load is that of all cells
    Vec3 force;
  };

  CellSide side_;
  CellPattern pattern_;
  double pressure_;
  Program program_;
  std::vector<Load> loads_;
};

}  // namespace plica
