#include "simulation/pace.hpp"

#include <fmt/format.h>

#include "tissue/mesh_quality.hpp"

namespace plica {

std::optional<Standstill> standstill(const Pace& pace, const RunControls& controls, const Model& model,
                                     const State& state) {
  constexpr double hard_step = 5, most_left = 10'000;  // Newton iterations
  constexpr double crushed = 0.01;
  const double advance_s = state.time_s - pace.since_s, step_s = advance_s / pace.steps;
  const double per_step = static_cast<double>(pace.iterations) / pace.steps;
  const double left = pace.iterations * (controls.end_s - state.time_s) / advance_s;
  if (per_step < hard_step || left < most_left) return std::nullopt;
  if (controls.fixed_step_s && step_s > 0.5 * *controls.fixed_step_s) return std::nullopt;
  const CornerRatio worst = least_corner_ratio(model.tissue, state.positions);
  if (worst.ratio > crushed) return std::nullopt;
  const int id = model.tissue.cells[worst.cell.index()].lineage.id;
  return Standstill{worst.cell, fmt::format("forces crush cell {} (a corner has {:.1g} of its volume), and {} steps of "
                                            "{:.1g} s on average took {:.0f} Newton iterations each",
                                            id, worst.ratio, pace.steps, step_s, per_step)};
}

}  // namespace plica
