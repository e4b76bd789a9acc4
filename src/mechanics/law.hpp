// What every law of mechanics offers. A law is a term of the step's incremental potential: its forces are the exact
// negative gradient of its energy and its tangent the exact Hessian, so that Newton's method converges quadratically
// and the line search has something to descend on.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

struct Tissue;
struct Division;

/// Where a step stands: the unknown positions at its end, and everything that is constant during it. What depends on
/// positions, q, changes at the step's end at the rate
///   (q(positions) - q_before) / rate_s,  q_before = q(previous) + ahead (q(previous) - q(earlier)),
/// with ahead = 0 and rate_s = h in a step of first order, of length h (docs/theory/step.md).
struct Step {
  std::span<const Vec3> positions;            // x at the end of the step, um; nodes
  std::span<const Vec3> previous_positions;   // x at its beginning, um; nodes
  std::span<const Vec3> previous_velocities;  // v at its beginning, um/s; nodes
  double rate_s = 0;                          // > 0
  double end_time_s = 0;                      // activity programs are read here
  // Whether tangents leave out what could make them indefinite, for a solver that needs a positive definite system.
  // Each law's header says what that is. Forces do not change.
  bool semidefinite_tangent = false;
  std::span<const Vec3> earlier_positions = {};  // x at the beginning of the step before, um; nodes; where ahead > 0
  double ahead = 0;                              // >= 0
  std::span<const std::vector<double>> internals = {};  // laws: their states at the step's beginning
  std::span<const double> internal = {};                // that of the law that is asked (for_laws)

  /// q_before of a quantity of node positions.
  template <class Quantity>
  [[nodiscard]] auto before(const Quantity& q) const -> decltype(q(previous_positions)) {
    if (ahead == 0) return q(previous_positions);
    return (1 + ahead) * q(previous_positions) - ahead * q(earlier_positions);
  }
};

/// A step that has been made, for its energies (docs/theory/energy.md).
struct MadeStep {
  Step begin, end;  // nothing moves on them: positions before it and after it, with the internal states of then
  Step whole;  // from the one to the other at mean rates, with the internal states before; programs are read midway
};

/// What a law has done over a step, nN um.
struct EnergyFlow {
  double active = 0;      // put in by what cells or the outside do
  double stored = 0;      // more in the tissue than before
  double dissipated = 0;  // lost for good

  EnergyFlow& operator+=(const EnergyFlow& more) {
    active += more.active, stored += more.stored, dissipated += more.dissipated;
    return *this;
  }
};

/// Collects 3 x 3 blocks of a symmetric tangent. `add_block(a, b, K)` adds K to the rows of a and columns of b and, for
/// two different nodes, its transpose to the rows of b and columns of a: each pair is given in one order only.
class TangentSink {
 public:
  virtual ~TangentSink() = default;
  virtual void add_block(NodeId row, NodeId column, const Mat3& block) = 0;

  /// Whether several threads may add blocks at once that end on different nodes; those of a hanging node end on the
  /// nodes that carry it.
  [[nodiscard]] virtual bool takes_apart() const { return false; }
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
  /// Where a group begins among the nodes of all groups; of `size()`, how many these are.
  [[nodiscard]] std::size_t start(std::size_t group) const { return starts_[group]; }
  bool operator==(const NodeGroups&) const = default;

 private:
  std::vector<std::size_t> starts_ = {0};
  std::vector<NodeId> nodes_;
};

/// One law. Vectors are a Vec3 a node; forces in nN, tangents in nN/um, energies in nN um. A law is constant during a
/// step; what it remembers from one step to the next (a rest length that flows, which nodes touch) is numbers that the
/// State holds for it, its internal state.
class Law {
 public:
  virtual ~Law() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Law> clone() const = 0;

  /// What tables of results call it: as the scenario does, cortex.apical; else by its name.
  [[nodiscard]] std::string label() const { return label_.empty() ? std::string(name()) : label_; }
  void set_label(std::string label) { label_ = std::move(label); }

  /// The law's part of the incremental potential.
  [[nodiscard]] virtual double energy(const Step& step) const = 0;

  /// Where energy has gone over a step. As it stands here, of a law that stores all of it: one that acts, resists
  /// motion or forgets says its own (docs/theory/energy.md).
  [[nodiscard]] virtual EnergyFlow energy_flow(const MadeStep& made) const {
    return {.stored = energy(made.end) - energy(made.begin)};
  }

  /// Adds -d(energy)/dx.
  virtual void add_forces(const Step& step, std::span<Vec3> forces) const = 0;

  /// Adds d2(energy)/dx2 times `direction`, without a matrix; or the semidefinite part of it that the step asks for.
  virtual void add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                   std::span<Vec3> product) const = 0;

  /// Adds the same as a matrix: the blocks of nodes that the law joins, each pair in one order (TangentSink). A law may
  /// leave out blocks that its product has, where they would fill the matrix: directions are then found by more
  /// iterations.
  virtual void add_tangent(const Step& step, TangentSink& tangent) const = 0;

  /// The nodes that the law joins, as long as its internal state has this revision of the pattern: only their blocks
  /// are in its tangent. Laws that act on single nodes have none.
  [[nodiscard]] virtual NodeGroups node_groups(std::span<const double> /*internal*/) const { return {}; }
  [[nodiscard]] virtual int pattern_revision(std::span<const double> /*internal*/) const { return 0; }

  /// What rounding of positions (um) makes of its forces, nN, norm over nodes: nothing solves below that. (That of
  /// elasticity is Model::elastic_rounding.)
  [[nodiscard]] virtual double rounding(const Step& /*step*/, double /*position_rounding*/) const { return 0; }

  /// How much of a change of positions may be tried at once, 0 to 1: for laws whose energy has a barrier.
  [[nodiscard]] virtual double max_fraction(const Step& /*step*/, std::span<const Vec3> /*direction*/) const {
    return 1;
  }

  /// The internal state before the first step, and at the end of a step that has been solved (and may still be refused,
  /// for its error: the law is not told).
  [[nodiscard]] virtual std::vector<double> first_internal(const Tissue& /*tissue*/) const { return {}; }
  [[nodiscard]] virtual std::vector<double> next_internal(const Step& step) const {
    return {step.internal.begin(), step.internal.end()};
  }

  /// The same law for the tissue after a division, with nodes at `positions`. Existing nodes feel the same forces, but
  /// for what finer elements change. Also asked for a tissue of which only some cells are kept (forces_of_cells), so
  /// not every cell of before need be there.
  [[nodiscard]] virtual std::unique_ptr<Law> after_division(const Tissue& tissue, const Division& division,
                                                            std::span<const Vec3> positions) const = 0;
  /// And its internal state, from that before; asked of the law before the division.
  [[nodiscard]] virtual std::vector<double> internal_after_division(std::span<const double> internal,
                                                                    const Tissue& /*tissue*/,
                                                                    const Division& /*division*/) const {
    return {internal.begin(), internal.end()};
  }

  /// Daughters have grown: the rest shapes of these elements are new. Between steps only.
  virtual void take_rest_shapes(const Tissue& /*tissue*/, std::span<const ElementId> /*elements*/) {}

  /// The volumes that cells are held at, um^3, where they are: after a division, and as daughters grow. Between steps
  /// only.
  virtual void take_cell_volumes(const Tissue& /*tissue*/, std::span<const double> /*volumes*/) {}

  /// Times at which its programs begin or bend, s: steps end on them.
  [[nodiscard]] virtual std::vector<double> program_points_s() const { return {}; }
  /// Those at which forces jump: there, what is known of past motion says nothing of what comes.
  [[nodiscard]] virtual std::vector<double> program_jumps_s() const { return {}; }

  /// Whether cells act by this law: its forces are then shown as the active ones. activity_of: of the cell's program at
  /// a time, or by its internal state; empty for a cell that the law leaves alone.
  [[nodiscard]] virtual bool is_active() const { return false; }
  [[nodiscard]] virtual std::optional<double> activity_of(CellId /*cell*/, double /*time_s*/,
                                                          std::span<const double> /*internal*/) const {
    return {};
  }

  /// The internal state with activities that cells are told from outside instead of those of their programs
  /// (given_activities.hpp). std::logic_error of a law by which no cell acts.
  [[nodiscard]] virtual std::vector<double> with_activities(std::span<const double> /*internal*/,
                                                            std::span<const double> /*activities*/) const {
    throw std::logic_error(label() + ": no cell acts by it");
  }

  /// Mass that the law gives to nodes, g; empty for none. At most one law of a model has any.
  [[nodiscard]] virtual std::span<const double> masses() const { return {}; }

 private:
  std::string label_;
};

}  // namespace plica
