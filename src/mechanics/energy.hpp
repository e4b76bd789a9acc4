// Energy budget of a step by law: work done by cells, stored and dissipated energy (docs/theory/energy.md).
#pragma once

#include <string>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// Duration of a step in which nothing moves: rates vanish, and it is too short for relaxation.
inline constexpr double no_time_s = 1e-9;

/// Return the step of duration `no_time_s` in which nodes stay where they are, at these velocities (nodes, um/s): laws
/// have the forces and energies of the state and its internal states.
Step motionless(const State& state, std::span<const Vec3> velocities);

/// Return the flow of a law that resists rates linearly: twice its energy is dissipated.
EnergyFlow viscous_energy_flow(const Law& law, const CompletedStep& completed);

/// Return the flow of a law that stores energy and relaxes: what its forces do not store of their work is dissipated.
EnergyFlow relaxing_energy_flow(const Law& law, const CompletedStep& completed);

/// Return the energy flows of the step from `before` to `after`: of each law in model order, then of cell volumes,
/// which do work only when cells grow. The model must have the rest shapes of growing cells midway through the step.
std::vector<EnergyFlow> energy_flows(const Model& model, const State& before, const State& after);

/// Names of these terms in tables.
std::vector<std::string> energy_labels(const Model& model);

}  // namespace plica
