// Interface of force laws. A law is a term of the incremental potential of a step: its forces are the exact negative
// gradient of its energy and its tangent the exact Hessian, so Newton's method converges quadratically and the line
// search has a merit function.
#pragma once

#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/number_list.hpp"
#include "core/vector.hpp"

namespace plica {

struct Tissue;
struct Model;
struct TissueChange;
struct CellPattern;
class EnclosedFluid;
class LawDerivatives;
class SelfContact;
struct GrowthTensor;
template <class Value>
struct ByCell;
using CellArray = ByCell<double>;

/// State of a step: the unknown positions at its end, and everything constant during it. A quantity q of positions
/// changes at the end of the step at the rate
///   (q(positions) - q_before) / rate_s,  q_before = q(previous) + ahead (q(previous) - q(earlier)),
/// with ahead = 0 and rate_s = h in a step of first order, of length h (docs/theory/step.md).
struct Step {
  std::span<const Vec3> positions;            // x at the end of the step, um; nodes
  std::span<const Vec3> previous_positions;   // x at its beginning, um; nodes
  std::span<const Vec3> previous_velocities;  // v at its beginning, um/s; nodes
  double rate_s = 0;                          // > 0
  double end_time_s = 0;                      // activity programs are read here
  // Whether tangents omit terms that could make them indefinite, for solvers of positive definite systems. The header
  // of each law names the omitted terms. Forces do not change.
  bool semidefinite_tangent = false;
  std::span<const Vec3> earlier_positions = {};  // x at the beginning of the step before, um; nodes; where ahead > 0
  double ahead = 0;                              // >= 0
  std::span<const std::vector<double>> internals = {};  // laws: their states at the step's beginning
  std::span<const double> internal = {};                // that of the present law (for_laws)
  const Model* grown = nullptr;                         // model at its end; null: that of the stepper (for_laws)

  /// Return q_before of a quantity of node positions.
  template <class Quantity>
  [[nodiscard]] auto before(const Quantity& q) const -> decltype(q(previous_positions)) {
    if (ahead == 0) return q(previous_positions);
    return extrapolated(q(previous_positions), q(earlier_positions));
  }
  /// Return its length, s: of a step w times as long as the last, rate_s is h (1 + w)/(1 + 2 w) and ahead
  /// w^2/(1 + 2 w).
  [[nodiscard]] double length_s() const {
    const double w = ahead + std::sqrt(ahead * (1 + ahead));
    return rate_s * (1 + 2 * w) / (1 + w);
  }
  /// Return q_before from the values at the beginning of this step and of the step before.
  template <class Value>
  [[nodiscard]] Value extrapolated(const Value& previous, const Value& earlier) const {
    return (1 + ahead) * previous - ahead * earlier;
  }
};

/// Completed step, for its energies (docs/theory/energy.md).
struct CompletedStep {
  Step begin, end;  // motionless: positions and internal states before and after the step
  Step motion;      // from one to the other at mean rates, with the internal states before; programs read midway
};

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

/// Positions of nodes at a change of the tissue, um; empty for a part of it.
struct ChangePositions {
  std::span<const Vec3> before, after;
};

/// Force law. Vectors have one Vec3 per node; forces in nN, tangents in nN/um, energies in nN um. A law is constant
/// during a step; its internal state (stress-free lengths, contact pairs) is an array of numbers held by State.
class Law {
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

  /// Return the internal state before the first step, or at the end of a converged step (which may still be rejected
  /// for its error; the law is not notified). A law that remembers what changes at a rate keeps it twice, for the
  /// beginning of this step and of the step before, since steps of second order need both (Step::extrapolated). With
  /// mirror planes the law exists twice, for the solved side and for the whole tissue (FullModel): both are asked.
  [[nodiscard]] virtual std::vector<double> first_internal(const Tissue& /*tissue*/) const { return {}; }
  [[nodiscard]] virtual std::vector<double> next_internal(const Step& step) const {
    return {step.internal.begin(), step.internal.end()};
  }
  /// Return the internal state of the law of the whole tissue that this one, of a side, implies; or nothing, and that
  /// law finds it itself.
  [[nodiscard]] virtual std::optional<std::vector<double>> internal_of_whole(
      std::span<const double> /*of_side*/) const {
    return std::nullopt;
  }
  /// Whether the law can read an internal state of a checkpoint. The default is for states of constant length.
  [[nodiscard]] virtual bool accepts(std::span<const double> internal, const Tissue& tissue) const {
    return internal.size() == first_internal(tissue).size();
  }

  /// Return the law for the tissue after a change (division, exchange, extrusion), with nodes at `positions`. Forces on
  /// existing nodes are unchanged by a division, except for effects of finer elements. Also called for a tissue of some
  /// cells only (forces_of_cells) and after extrusion, so previous cells and nodes may be missing.
  [[nodiscard]] virtual std::unique_ptr<Law> after_division(const Tissue& tissue, const TissueChange& change,
                                                            std::span<const Vec3> positions) const = 0;
  /// Return the internal state after a change of the tissue from the one before; called on the law before the change.
  [[nodiscard]] virtual std::vector<double> internal_after_division(std::span<const double> internal,
                                                                    const Tissue& /*tissue*/,
                                                                    const TissueChange& /*change*/,
                                                                    const ChangePositions& /*positions*/) const {
    return {internal.begin(), internal.end()};
  }

  /// Return the mean left Cauchy-Green tensor of the elastic strain in these elements; none for laws without.
  [[nodiscard]] virtual std::optional<Mat3> elastic_stretch(std::span<const double> /*internal*/,
                                                            std::span<const Vec3> /*positions*/,
                                                            std::span<const ElementId> /*elements*/) const {
    return std::nullopt;
  }

  /// Return the data that past divisions left in the law: numbers that the law of the initial tissue, the origins of
  /// cells and the present tissue do not determine.
  [[nodiscard]] virtual std::vector<double> past() const { return {}; }
  /// Return the law with this past for a tissue that divisions made of its own; `change` has no new nodes. Called on
  /// the law of the initial tissue, with reference positions. Throws InvalidNumbers for the past of another law or
  /// tissue.
  [[nodiscard]] virtual std::unique_ptr<Law> restored(const Tissue& tissue, const TissueChange& change,
                                                      std::span<const Vec3> positions,
                                                      std::span<const double> past) const {
    if (!past.empty()) throw InvalidNumbers();
    return after_division(tissue, change, positions);
  }

  /// Return the law for the tissue after growth, in which these elements have other rest shapes, and cells other target
  /// volumes. `tensors`: growth of each cell since the last change of the tissue (`grow`); may be empty.
  [[nodiscard]] virtual std::unique_ptr<Law> grown(const Tissue& tissue, std::span<const ElementId> elements,
                                                   std::span<const GrowthTensor> /*tensors*/) const {
    std::unique_ptr<Law> law = clone();
    for (const ElementId e : elements) law->fit(tissue, e.index());
    return law;
  }

  /// Multiply the growth of cells by that of this law, from the last change of the tissue to a time at or after that of
  /// the internal state. Laws without growth do nothing; without any, `tensors` stays empty.
  virtual void grow(std::span<const double> /*internal*/, double /*time_s*/,
                    std::vector<GrowthTensor>& /*tensors*/) const {}
  /// Whether any cell grows or shrinks just after a time.
  [[nodiscard]] virtual bool is_growing(std::span<const double> /*internal*/, double /*time_s*/) const { return false; }

  /// Return times at which its programs begin or bend, s; steps end on them.
  [[nodiscard]] virtual std::vector<double> program_points_s() const { return {}; }
  /// Return times at which forces jump, s; past motion does not predict motion after them.
  [[nodiscard]] virtual std::vector<double> program_jumps_s() const { return {}; }

  /// Whether this law is active: its forces are shown as active forces. activity_of returns the activity of a cell at a
  /// time, by program or internal state; empty for other cells.
  [[nodiscard]] virtual bool is_active() const { return false; }
  [[nodiscard]] virtual std::optional<double> activity_of(CellId /*cell*/, double /*time_s*/,
                                                          std::span<const double> /*internal*/) const {
    return {};
  }

  /// Return the internal state with activities set from outside instead of by programs (GivenActivities).
  /// std::logic_error for laws that are not active.
  [[nodiscard]] virtual std::vector<double> with_activities(std::span<const double> /*internal*/,
                                                            std::span<const double> /*activities*/) const {
    throw std::logic_error(label() + ": is not an active law");
  }

  /// Return the internal state with activities that follow the signals of a state (cells, by signal) at its time.
  [[nodiscard]] virtual std::vector<double> with_signals(std::span<const double> internal,
                                                         std::span<const CellArray> /*signals*/,
                                                         double /*time_s*/) const {
    return {internal.begin(), internal.end()};
  }

  /// Return region, amplitudes and ablations of a law that acts by cells; null for others.
  [[nodiscard]] virtual const CellPattern* pattern() const { return nullptr; }

  /// Return its derivatives for gradients of runs (derivatives.hpp). Throws NoGradient, with what the user can do, if
  /// it has none.
  [[nodiscard]] virtual const LawDerivatives& derivatives() const;

  /// What measures read of a law; null, or empty, for others: its contact pairs, the fluid that it encloses, and the
  /// mean tension of its faces, nN/um.
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
