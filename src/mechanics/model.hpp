// The model of a run (constant) and its state (everything that changes).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/constraint.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/law.hpp"
#include "mechanics/obstacle.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// A daughter on her way from a half of her mother to her final size: linear in time.
struct Growth {
  CellId cell;
  std::vector<Vec3> rest_from, rest_to;   // um; corners, as Cell::rest_shape
  double target_from = 0, target_to = 0;  // volume, um^3
  double start_s = 0, end_s = 0;

  /// Part of the way, 0 to 1.
  [[nodiscard]] double part(double time_s) const;
};

/// Topology and parameters. Constant during a step; between steps cells may divide and grow (mechanics/division.hpp).
struct Model {
  Tissue tissue;
  std::vector<std::unique_ptr<Law>> laws;
  std::vector<std::unique_ptr<Constraint>> constraints;  // the first is that of the cells' volumes
  std::vector<std::unique_ptr<Obstacle>> obstacles;
  std::vector<std::array<bool, 3>> held;  // nodes; directions x, y, z in which a node does not move
  std::vector<Growth> growths;            // under way, and over since the last division
  double stiffness_scale = 1;             // Young's modulus, kPa: for tolerances that must not depend on the load

  /// Nothing but the cells' volumes, which are held.
  explicit Model(Tissue t);
  Model(const Model& other);
  Model(Model&&) = default;
  Model& operator=(Model&&) = default;

  [[nodiscard]] CellVolumes& volumes() { return static_cast<CellVolumes&>(*constraints.front()); }
  [[nodiscard]] const CellVolumes& volumes() const { return static_cast<const CellVolumes&>(*constraints.front()); }

  /// How many multipliers all constraints have.
  [[nodiscard]] std::size_t multiplier_count() const;

  /// Mass of the nodes, g; empty in a model without inertia.
  [[nodiscard]] std::span<const double> masses() const;

  /// Typical force of the body, nN: modulus times the mean area of an element's face. Residuals are zero against this.
  [[nodiscard]] double force_scale() const;

  /// What rounding of positions makes of elastic forces (nN, norm over nodes): nothing solves below that. Matters for
  /// cells that are very thin beside the embryo.
  [[nodiscard]] double elastic_rounding() const;
  /// How far positions are rounded, with a margin for sums, um.
  [[nodiscard]] double position_rounding() const;
};

/// The place in model.laws of the one that tables call so; of those by which cells act, where `acting` asks for that.
/// UsageError, with the names that there are.
std::size_t place_of_law(const Model& model, const std::string& label, bool acting = false);

/// Calls body(law, step as that law sees it) for every law.
template <class Body>
void for_laws(const Model& model, const Step& step, const Body& body) {
  Step own = step;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    own.internal = l < step.internals.size() ? std::span<const double>(step.internals[l]) : std::span<const double>{};
    body(*model.laws[l], own);
  }
}

/// The internal states of all laws at the end of a step, whose positions are there.
std::vector<std::vector<double>> next_internals(const Model& model, const Step& step);

/// Calls body(constraint, where its multipliers begin among all, its place in the model) for every constraint that a
/// step holds.
template <class Body>
void for_held_constraints(const Model& model, const Body& body) {
  std::size_t first = 0;
  for (std::size_t place = 0; place < model.constraints.size(); ++place) {
    const Constraint& constraint = *model.constraints[place];
    if (constraint.is_held()) body(constraint, first, place);
    first += constraint.count();
  }
}

/// Where the body is. What a run needs beside it to go on to the same bits is in RunMemory.
struct State {
  double time_s = 0;
  Vectors positions;                           // nodes; um
  Vectors velocities;                          // nodes; um/s, at the end of the last step
  std::vector<double> multipliers;             // the constraints', one after the other; first the cells' pressures, kPa
  std::vector<double> contact_forces;          // Contacts; nN, >= 0
  std::vector<char> in_contact;                // Contacts
  std::vector<std::vector<double>> internals;  // laws: what each remembers (Law::next_internal)
  double divided_until_s = -1;                 // divisions that were due up to here have been made

  // How things last changed (record_motion), from which the next step's end is forecast. Empty when that is not known:
  // at the start and after a division.
  struct Trend {
    double step_s = 0;                     // the last step
    double earlier_s = 0;                  // the one before it
    Vectors mean_velocities;               // nodes; um/s, over the last step; empty where they are the velocities
    Vectors accelerations;                 // nodes; um/s^2, between the middles of these two steps
    std::vector<double> multiplier_rates;  // a second
  } trend;

  /// The cells' pressures, kPa.
  [[nodiscard]] std::span<const double> pressures(const Model& model) const {
    return std::span(multipliers).first(model.tissue.cells.size());
  }
};

/// The model at rest, before the first step.
State rest_state(const Model& model);

}  // namespace plica
