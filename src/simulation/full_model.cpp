#include "simulation/full_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/errors.hpp"
#include "mechanics/derivatives.hpp"
#include "solver/step/backward_difference.hpp"

namespace plica {

FullModel::FullModel(Model model, Mirror mirror)
    : model_(std::move(model)), mirror_(std::move(mirror)), state_(rest_state(model_)) {}

// State without the internal variables of laws.
State FullModel::whole_of(const Model& side, const State& state) const {
  const auto vectors = [&](const Vectors& of_side) {
    return of_side.empty() ? Vectors() : mirror_.full_vectors(of_side);
  };
  const auto multipliers = [&](const std::vector<double>& of_side) {
    std::vector<double> all;
    if (of_side.empty()) return all;
    for (const CellId cell : mirror_.cells) all.push_back(of_side[cell.index()]);
    const auto others = static_cast<std::ptrdiff_t>(side.tissue.cells.size());
    all.insert(all.end(), of_side.begin() + others, of_side.end());
    return all;
  };
  State whole;
  whole.time_s = state.time_s;
  whole.positions = vectors(state.positions);
  whole.velocities = vectors(state.velocities);
  whole.multipliers = multipliers(state.multipliers);
  whole.divided_until_s = state.divided_until_s;
  for (const CellArray& of_side : state.signals) {
    CellArray& all = whole.signals.emplace_back();
    for (const CellId cell : mirror_.cells) all.push_back(of_side[cell.index()]);
  }
  whole.trend = {.step_s = state.trend.step_s,
                 .earlier_s = state.trend.earlier_s,
                 .mean_velocities = vectors(state.trend.mean_velocities),
                 .accelerations = vectors(state.trend.accelerations),
                 .multiplier_rates = multipliers(state.trend.multiplier_rates)};
  std::size_t first = 0;  // of the obstacle's contacts on the side
  for (std::size_t o = 0; o < side.obstacles.size(); ++o) {
    const std::span<const NodeId> nodes = side.obstacles[o]->nodes();
    for (const NodeId of_whole : model_.obstacles[o]->nodes()) {
      const NodeId node = mirror_.image(of_whole).node;
      const auto contact = first + static_cast<std::size_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
      // Contact forces at nodes on a mirror plane are divided by the share of the side.
      whole.obstacle_forces.push_back(state.obstacle_forces[contact] / side.tissue.side_share({&node, 1}));
      whole.on_obstacle.push_back(state.on_obstacle[contact]);
    }
    first += nodes.size();
  }
  return whole;
}

void FullModel::grow(double time_s) {
  if (std::optional<Model> later = grown(model_, model(), state_.internals, time_s)) grown_ = std::move(later);
}

State FullModel::follow(const Model& side, const State& state) {
  State next = whole_of(side, state);
  grow(next.time_s);
  const BackwardDifference rates = rates_of(state_, next);
  const Vectors earlier = rates.ahead > 0 ? earlier_positions(state_) : Vectors();
  const Step step{.positions = next.positions,
                  .previous_positions = state_.positions,
                  .previous_velocities = state_.velocities,
                  .rate_s = rates.rate_s,
                  .end_time_s = next.time_s,
                  .earlier_positions = earlier,
                  .ahead = rates.ahead,
                  .internals = state_.internals};
  for_laws(model(), step, [&](const Law& law, const Step& law_step) {
    const std::size_t l = next.internals.size();
    auto implied = side.laws[l]->internal_of_whole(state.internals[l]);
    next.internals.push_back(implied ? std::move(*implied) : law.next_internal(law_step));
  });
  follow_signals(model(), next);
  return std::exchange(state_, std::move(next));
}

void FullModel::go_to(const Model& side, const State& state, std::vector<std::vector<double>> internals) {
  state_ = whole_of(side, state);
  state_.internals = std::move(internals);
  grow(state_.time_s);
}

std::vector<double> FullModel::of_side(const std::string& what, const std::string& noun,
                                       const std::vector<double>& values) const {
  for (std::size_t c = 0; c < values.size(); ++c)
    if (const CellId original = mirror_.original(CellId(c)); values[c] != values[original.index()])
      throw UsageError(
          fmt::format("{}: cells {} and {} are mirror images, and their {} are {} and {}; give "
                      "both the same value, or remove embryo.mirror",
                      what, c, original.index(), noun, values[c], values[original.index()]));
  std::vector<double> result;
  for (const CellId cell : mirror_.origins)
    if (!values.empty()) result.push_back(values[cell.index()]);
  return result;
}

std::vector<double> FullModel::take_activities(std::size_t law, const std::vector<double>& activities) {
  std::vector<double> side = of_side(model_.laws[law]->label(), "activities", activities);
  state_.internals[law] = model_.laws[law]->with_activities(state_.internals[law], activities);
  return side;
}

CellArray FullModel::take_signal(std::size_t signal, const CellArray& values) {
  CellArray side = of_side("signal " + model_.signals.rules()[signal].name, "concentrations", values);
  state_.signals[signal] = values;
  follow_signals(model_, state_);
  return side;
}

std::vector<double> FullModel::scale_strengths(std::size_t law, const std::vector<double>& factors) {
  std::vector<double> side = of_side(model_.laws[law]->label(), "strengths", factors);
  model_.laws[law] = with_strengths(*model_.laws[law], factors);
  return side;
}

}  // namespace plica
