// Model of a run (constant) and its state (everything that changes).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "mechanics/constraint.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/growth.hpp"
#include "mechanics/law.hpp"
#include "mechanics/obstacle.hpp"
#include "mechanics/signals/signals.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Topology and parameters. Constant between divisions: while cells grow, each step has a model of its own (`grown`,
/// mechanics/growth.hpp).
struct Model {
  Tissue tissue;
  CellVolumes volumes;  // a constraint whose multipliers come before those of the others
  std::vector<std::unique_ptr<Law>> laws;
  std::vector<std::unique_ptr<Constraint>> constraints;
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  Signals signals;
  std::vector<std::array<bool, 3>> held;  // nodes; fixed directions x, y, z
  std::vector<Growth> growths;            // of daughters; in progress, or finished since the last division
  double stiffness_scale = 1;             // Young's modulus, kPa, for load-independent tolerances
  std::uint64_t revision = ++revisions;   // number of its own; another after a division
  static inline std::atomic<std::uint64_t> revisions = 0;

  /// Make a model with held cell volumes and no laws.
  explicit Model(Tissue t);
  Model(const Model& other) : Model(other, other.tissue, {}, {}) {}
  /// Make a copy whose cells have the rest shapes and target volumes of `t`, with other rest shapes of these elements;
  /// `tensors`: growth of cells since the last change of the tissue, or none.
  Model(const Model& other, Tissue t, std::span<const ElementId> reshaped, std::span<const GrowthTensor> tensors);
  Model(Model&&) = default;
  Model& operator=(Model&&) = default;

  /// Return a constraint by its place: the cell volumes, then the others.
  [[nodiscard]] const Constraint& constraint(std::size_t place) const {
    return place == 0 ? static_cast<const Constraint&>(volumes) : *constraints[place - 1];
  }
  [[nodiscard]] std::size_t constraint_count() const { return 1 + constraints.size(); }

  [[nodiscard]] std::size_t multiplier_count() const;

  /// Return nodal masses, g; empty without inertia.
  [[nodiscard]] std::span<const double> masses() const;

  /// Return the typical force of the body, nN: modulus times the mean face area of elements. Residuals are scaled by
  /// it.
  [[nodiscard]] double force_scale() const;

  /// Return the error of elastic forces caused by rounding of positions (nN, norm over nodes): a lower bound for
  /// convergence. Relevant for cells much thinner than the embryo.
  [[nodiscard]] double elastic_rounding() const;
  /// Return the rounding error of positions, with a margin for sums, um.
  [[nodiscard]] double position_rounding() const;
};

/// Return the index in model.laws of the law with this label; if `acting`, among active laws only. UsageError lists
/// the existing labels.
std::size_t place_of_law(const Model& model, const std::string& label, bool acting = false);

inline const Model& at_end(const Model& model, const Step& step) { return step.grown ? *step.grown : model; }

/// Call body(law at the end of the step, step as seen by that law) for every law.
template <class Body>
void for_laws(const Model& model, const Step& step, const Body& body) {
  Step law_step = step;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    law_step.internal =
        l < step.internals.size() ? std::span<const double>(step.internals[l]) : std::span<const double>{};
    body(*at_end(model, step).laws[l], law_step);
  }
}

/// Return the internal states of all laws at the end of a step, at whose end positions are.
std::vector<std::vector<double>> next_internals(const Model& model, const Step& step);

/// Call body(constraint, index of its first multiplier, index in the model) for every held constraint.
template <class Body>
void for_held_constraints(const Model& model, const Body& body) {
  std::size_t first = 0;
  for (std::size_t place = 0; place < model.constraint_count(); ++place) {
    const Constraint& constraint = model.constraint(place);
    if (constraint.is_held()) body(constraint, first, place);
    first += constraint.count();
  }
}

/// Exchanges of neighbours and extrusions so far.
struct Exchanges {
  struct Turned {
    NodeId begin, end;  // basal; free
    double time_s = 0;
    static auto parts(auto& one) { return std::tie(one.begin, one.end, one.time_s); }
  };
  double until_s = -1;         // those due until then are done
  int count = 0;               // walls that have turned
  double energy = 0;           // nN um: change of energy at these events (mechanics/exchange.hpp)
  double shear = 0;            // of the tissue, with and without exchanges (measure/neighbours.hpp)
  std::vector<Turned> recent;  // walls that must not turn back yet
  int extruded = 0;            // cells that have left
  double extruded_um3 = 0;     // their volumes then

  static auto parts(auto& all) {
    return std::tie(all.until_s, all.count, all.energy, all.shear, all.recent, all.extruded, all.extruded_um3);
  }
};

/// State of the body. RunMemory holds what a run also needs to continue bitwise identically.
struct State {
  double time_s = 0;
  Vectors positions;                           // nodes; um
  Vectors velocities;                          // nodes; um/s, at the end of the last step
  std::vector<double> multipliers;             // all constraints, consecutively; first cell pressures, kPa
  std::vector<double> obstacle_forces;         // ObstacleContacts; nN, >= 0
  std::vector<char> on_obstacle;               // ObstacleContacts
  std::vector<std::vector<double>> internals;  // laws: internal states (Law::next_internal)
  Signals::Values signals;                     // concentrations; cells, by signal of the model
  double divided_until_s = -1;                 // divisions due until then are done
  Exchanges exchanges;

  // Recent rates of change (record_motion), from which the end of the next step is predicted. Empty if unknown: at the
  // start and after a division.
  struct Trend {
    double step_s = 0;                     // length of the last step
    double earlier_s = 0;                  // length of the one before
    Vectors mean_velocities;               // nodes; um/s, over the last step; empty if equal to velocities
    Vectors accelerations;                 // nodes; um/s^2, between the midpoints of these two steps
    std::vector<double> multiplier_rates;  // per second
  } trend;

  /// Return cell pressures, kPa.
  [[nodiscard]] std::span<const double> pressures(const Model& model) const {
    return std::span(multipliers).first(model.tissue.cells.size());
  }
};

/// Advance the signals from one state to another, whose positions and time are known, and let activities of laws follow
/// them. On failure they are unchanged. `model`: at the end of the step.
std::optional<SignalFailure> advance_signals(const Model& model, const State& before, State& after);

/// Let the activities of laws follow the signals of the state.
void follow_signals(const Model& model, State& state);

/// Return the reference state, before the first step.
State rest_state(const Model& model);

}  // namespace plica
