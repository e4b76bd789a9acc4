// Interface of force laws. A law is a term of the incremental potential of a step: its forces are the exact negative
// gradient of its energy and its tangent the exact Hessian, so Newton's method converges quadratically and the line
// search has a merit function.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "mechanics/law_activity.hpp"
#include "mechanics/law_change.hpp"
#include "mechanics/law_memory.hpp"
#include "mechanics/step.hpp"

namespace plica {

class Cortex;
class EnclosedFluid;
class LawDerivatives;
class SelfContact;

/// Energy flows of a law over a step, nN um.
struct EnergyFlow {
  double active = 0;      // work done by cells or external loads
  double stored = 0;      // increase in the tissue
  double dissipated = 0;  // lost as heat

  EnergyFlow& operator+=(const EnergyFlow& more) {
    active += more.active, stored += more.stored, dissipated += more.dissipated;
    return *this;
  }
  static auto parts(auto& flow) { return std::tie(flow.active, flow.stored, flow.dissipated); }
};

/// Sink of 3 x 3 blocks of a symmetric tangent. `add_block(a, b, K)` adds K to the rows of a and columns of b and, for
/// two different nodes, its transpose to the rows of b and columns of a: each pair is given in one order only.
class TangentSink {
 public:
  virtual ~TangentSink() = default;
  virtual void add_block(NodeId row, NodeId column, const Mat3& block) = 0;

  /// Whether several threads may add blocks for different nodes at once; blocks of a hanging node go to the nodes that
  /// carry it.
  [[nodiscard]] virtual bool accepts_concurrent_blocks() const { return false; }
};

/// Groups of nodes whose tangent blocks may be non-zero: the sparsity pattern of a law.
class NodeGroups {
 public:
  void add(std::span<const NodeId> group) {
    nodes_.insert(nodes_.end(), group.begin(), group.end());
    starts_.push_back(nodes_.size());
  }
  [[nodiscard]] std::size_t size() const { return starts_.size() - 1; }
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] std::span<const NodeId> operator[](std::size_t group) const {
    return std::span(nodes_).subspan(starts_[group], starts_[group + 1] - starts_[group]);
  }
  /// Index at which a group begins among the nodes of all groups; for `size()`, their total number.
  [[nodiscard]] std::size_t start(std::size_t group) const { return starts_[group]; }
  bool operator==(const NodeGroups&) const = default;

 private:
  std::vector<std::size_t> starts_ = {0};
  std::vector<NodeId> nodes_;
};

/// Force law: a potential, and what else it may do (its bases). Vectors have one Vec3 per node; forces in nN, tangents
/// in nN/um, energies in nN um. A law is constant during a step.
class Law : public LawMemory, public LawChange, public LawActivity {
 public:
  virtual ~Law() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Law> clone() const = 0;

  /// Law identifier in results: as in the scenario (cortex.apical), else its name.
  [[nodiscard]] std::string label() const { return label_.empty() ? std::string(name()) : label_; }
  void set_label(std::string label) { label_ = std::move(label); }

  /// Return its term of the incremental potential.
  [[nodiscard]] virtual double energy(const Step& step) const = 0;

  /// Return the energy flows of a step. The default is for laws that store all energy; active, dissipative or relaxing
  /// laws override it (docs/theory/energy.md).
  [[nodiscard]] virtual EnergyFlow energy_flow(const CompletedStep& completed) const {
    return {.stored = energy(completed.end) - energy(completed.begin)};
  }

  /// Add -d(energy)/dx.
  virtual void add_forces(const Step& step, std::span<Vec3> forces) const = 0;

  /// Add d2(energy)/dx2 times `direction`, matrix-free; or its semidefinite part if the step asks for it.
  virtual void add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                   std::span<Vec3> product) const = 0;

  /// Add the tangent as a matrix: blocks of the nodes that the law joins, each pair in one order (TangentSink). A law
  /// may omit blocks that would fill the matrix; directions then take more iterations.
  virtual void add_tangent(const Step& step, TangentSink& tangent) const = 0;

  /// Return the groups of nodes that the law joins; valid until their revision changes, and only their blocks are
  /// in the tangent. Laws on single nodes have none.
  [[nodiscard]] virtual NodeGroups node_groups(std::span<const double> /*internal*/) const { return {}; }
  [[nodiscard]] virtual int groups_revision(std::span<const double> /*internal*/) const { return 0; }

  /// Return the force error caused by rounding of positions (um), nN, norm over nodes: a lower bound for convergence.
  /// (Elasticity: Model::elastic_rounding.)
  [[nodiscard]] virtual double rounding(const Step& /*step*/, double /*position_rounding*/) const { return 0; }

  /// Return the largest admissible fraction of a change of positions, 0 to 1, for laws with an energy barrier.
  [[nodiscard]] virtual double max_fraction(const Step& /*step*/, std::span<const Vec3> /*direction*/) const {
    return 1;
  }

  /// Return the mean left Cauchy-Green tensor of the elastic strain in these elements; none for laws without.
  [[nodiscard]] virtual std::optional<Mat3> elastic_stretch(std::span<const double> /*internal*/,
                                                            std::span<const Vec3> /*positions*/,
                                                            std::span<const ElementId> /*elements*/) const {
    return std::nullopt;
  }

  /// Add the integral of its passive Cauchy stress over each cell, nN um: neither of viscosity nor of what is active.
  virtual void add_stress_integrals(const Step& /*step*/, std::span<Mat3> /*of_cells*/) const {}

  [[nodiscard]] std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements,
                                           std::span<const GrowthTensor> /*tensors*/) const override {
    std::unique_ptr<Law> law = clone();
    for (const ElementId e : elements) law->fit(tissue, e.index());
    return law;
  }

  /// Return its derivatives for gradients of runs (derivatives.hpp). Throws NoGradient, with what the user can do, if
  /// it has none.
  [[nodiscard]] virtual const LawDerivatives& derivatives() const;

  /// What measures read of a law; null, or empty, for others: tensions of its faces, its contact pairs, the fluid that
  /// it encloses, and the mean tension of its faces, nN/um.
  [[nodiscard]] virtual const Cortex* cortex() const { return nullptr; }
  [[nodiscard]] virtual const SelfContact* self_contact() const { return nullptr; }
  [[nodiscard]] virtual const EnclosedFluid* enclosed_fluid() const { return nullptr; }
  [[nodiscard]] virtual std::optional<double> mean_tension(const Step& /*step*/) const { return std::nullopt; }

  /// Whether a sheet of few of its elements through the height bends too far (measure/bending_error.hpp).
  [[nodiscard]] virtual bool overbends() const { return false; }

  /// Return nodal masses, g; empty for none. At most one law of a model has masses.
  [[nodiscard]] virtual std::span<const double> masses() const { return {}; }

 protected:
  /// Throw NoGradient for this law: what has no derivatives, and what the user can do.
  [[noreturn]] void refuse_gradient(std::string_view why) const;

 private:
  /// Compute its data of an element from the rest shape.
  virtual void fit(const Tissue& /*tissue*/, std::size_t /*element*/) {}

  std::string label_;
};

/// Derivatives of every law whose forces depend on positions at the end of a step and on time only.
const LawDerivatives& static_derivatives();

}  // namespace plica
