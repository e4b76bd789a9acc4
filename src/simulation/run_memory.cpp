#include "simulation/run_memory.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/clock.hpp"

namespace plica {
namespace {

// Activities that were set from outside follow the law's own numbers (GivenActivities).
bool accepts(const Law& law, std::span<const double> internal, const Tissue& tissue) {
  const std::size_t cells = tissue.cells.size();
  return law.accepts(internal, tissue) ||
         (law.is_active() && internal.size() >= cells && law.accepts(internal.first(internal.size() - cells), tissue));
}

}  // namespace

bool has_ended(const RunMemory& run, const RunControls& controls) {
  return run.measures.is_over || (run.at_equilibrium && controls.stop_at_equilibrium) ||
         has_come(controls.end_s, run.state.time_s);
}

std::optional<std::string> why_unfit(const RunMemory& run, const Model& model) {
  const std::size_t nodes = model.tissue.node_count(), multipliers = model.multiplier_count(),
                    contacts = ObstacleContacts(model).size();
  const auto none_or = [](std::size_t size, std::size_t full) { return size == 0 || size == full; };
  const State& state = run.state;
  if (state.time_s < 0 || run.steps < 0 || run.wanted_step_s < 0 || run.careful_steps < 0 || state.trend.step_s < 0 ||
      state.trend.earlier_s < 0)
    return "its time or step is negative";
  if (!(run.pace.since_s >= 0 && run.pace.since_s <= state.time_s) || run.pace.steps < 0 || run.pace.iterations < 0)
    return "its pace is invalid";
  if (state.trend.step_s + state.trend.earlier_s > state.time_s * (1 + 1e-9))
    return "its steps are longer than its time";
  if (state.positions.size() != nodes || state.velocities.size() != nodes || state.multipliers.size() != multipliers ||
      state.obstacle_forces.size() != contacts || state.on_obstacle.size() != contacts ||
      !none_or(state.trend.mean_velocities.size(), nodes) || !none_or(state.trend.accelerations.size(), nodes) ||
      !none_or(state.trend.multiplier_rates.size(), multipliers) ||
      !none_or(run.energies.size(), model.laws.size() + 1))
    return "its state does not fit this embryo";
  if (state.signals.size() != model.signals.size() ||
      std::ranges::any_of(state.signals, [&](const CellArray& c) { return c.size() != model.tissue.cells.size(); }))
    return "its signals do not fit this embryo";
  return why_unfit(state.internals, model);
}

std::optional<std::string> why_unfit(std::span<const std::vector<double>> internals, const Model& model) {
  if (internals.size() != model.laws.size()) return "its laws are not those of this embryo";
  for (std::size_t l = 0; l < internals.size(); ++l)
    if (!accepts(*model.laws[l], internals[l], model.tissue))
      return fmt::format("its internal state of {} does not fit this law", model.laws[l]->label());
  return std::nullopt;
}

}  // namespace plica
