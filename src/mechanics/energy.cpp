#include "mechanics/energy.hpp"

namespace plica {
namespace {

std::span<const double> internal_of(const State& state, std::size_t law) {
  return law < state.internals.size() ? std::span<const double>(state.internals[law]) : std::span<const double>{};
}

// The work of the cells' pressures, by the mean of before and after.
double work_of_pressures(const Model& model, const State& before, const State& after) {
  const std::vector<double> from = model.volumes.volumes(before.positions), to = model.volumes.volumes(after.positions);
  double work = 0;
  for (std::size_t c = 0; c < from.size(); ++c)
    work += 0.5 * (before.multipliers[c] + after.multipliers[c]) * (to[c] - from[c]);
  return work;
}

}  // namespace

Step motionless(const State& state, std::span<const Vec3> velocities) {
  Step step;
  step.positions = step.previous_positions = state.positions;
  step.previous_velocities = velocities;
  step.rate_s = no_time_s;
  step.end_time_s = state.time_s;
  step.internals = state.internals;
  return step;
}

EnergyFlow viscous_energy_flow(const Law& law, const CompletedStep& completed) {
  const double now = law.energy(completed.end);
  return {.stored = now - law.energy(completed.begin), .dissipated = 2 * (law.energy(completed.motion) - now)};
}

// The work is that of the mean force of both ends of the step.
EnergyFlow relaxing_energy_flow(const Law& law, const CompletedStep& completed) {
  EnergyFlow flow = law.Law::energy_flow(completed);
  Vectors mean(completed.end.positions.size(), Vec3::Zero());
  law.add_forces(completed.begin, mean);
  law.add_forces(completed.end, mean);
  for (std::size_t n = 0; n < mean.size(); ++n)
    flow.dissipated -= 0.5 * mean[n].dot(completed.end.positions[n] - completed.begin.positions[n]);
  flow.dissipated -= flow.stored;
  return flow;
}

std::vector<EnergyFlow> energy_flows(const Model& model, const State& before, const State& after) {
  CompletedStep completed{motionless(before, before.velocities), motionless(after, after.velocities), {}};
  completed.motion.positions = after.positions;
  completed.motion.previous_positions = before.positions;
  completed.motion.previous_velocities = before.velocities;
  completed.motion.rate_s = after.time_s - before.time_s;
  completed.motion.end_time_s = 0.5 * (before.time_s + after.time_s);
  std::vector<EnergyFlow> flows;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    completed.begin.internal = completed.motion.internal = internal_of(before, l);
    completed.end.internal = internal_of(after, l);
    flows.push_back(model.laws[l]->energy_flow(completed));
  }
  flows.emplace_back();
  if (model.volumes.is_held() && (!model.growths.empty() || cells_grow(model, before.internals, before.time_s)))
    flows.back().active = work_of_pressures(model, before, after);
  return flows;
}

std::vector<std::string> energy_labels(const Model& model) {
  std::vector<std::string> labels;
  for (const auto& law : model.laws) labels.push_back(law->label());
  labels.emplace_back("growth");
  return labels;
}

}  // namespace plica
