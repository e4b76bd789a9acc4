#include "simulation/whole.hpp"

#include <algorithm>
#include <utility>

#include "solver/step/backward_difference.hpp"

namespace plica {

Whole::Whole(std::unique_ptr<Model> model, Mirror mirror)
    : model_(std::move(model)), mirror_(std::move(mirror)), state_(rest_state(*model_)) {}

Whole::Whole(const Whole& other)
    : model_(std::make_unique<Model>(*other.model_)), mirror_(other.mirror_), state_(other.state_) {}

// But what its laws remember, and what is forecast.
State Whole::whole_of(const Model& side, const State& state) const {
  State whole;
  whole.time_s = state.time_s;
  whole.divided_until_s = state.divided_until_s;
  whole.trend.step_s = state.trend.step_s;
  whole.positions = mirror_.whole(state.positions);
  whole.velocities = mirror_.whole(state.velocities);
  for (const CellId cell : mirror_.cells) whole.multipliers.push_back(state.multipliers[cell.index()]);
  const auto others = static_cast<std::ptrdiff_t>(side.tissue.cells.size());
  whole.multipliers.insert(whole.multipliers.end(), state.multipliers.begin() + others, state.multipliers.end());
  std::size_t first = 0;  // of the obstacle's contacts on the side
  for (std::size_t o = 0; o < side.obstacles.size(); ++o) {
    const std::span<const NodeId> nodes = side.obstacles[o]->nodes();
    for (const NodeId of_whole : model_->obstacles[o]->nodes()) {
      const NodeId node = mirror_.image(of_whole).node;
      const std::size_t contact =
          first + static_cast<std::size_t>(std::ranges::lower_bound(nodes, node) - nodes.begin());
      // A node on a mirror plane bears its own share there.
      whole.contact_forces.push_back(state.contact_forces[contact] / side.tissue.own_share({&node, 1}));
      whole.in_contact.push_back(state.in_contact[contact]);
    }
    first += nodes.size();
  }
  return whole;
}

State Whole::follow(const Model& side, const State& before, const State& after) {
  State next = whole_of(side, after);
  const BackwardDifference rates = rates_of(before, after);
  const Vectors earlier = rates.ahead > 0 ? mirror_.whole(earlier_positions(before)) : Vectors();
  next.internals = next_internals(*model_, {.positions = next.positions,
                                            .previous_positions = state_.positions,
                                            .previous_velocities = state_.velocities,
                                            .rate_s = rates.rate_s,
                                            .end_time_s = next.time_s,
                                            .earlier_positions = earlier,
                                            .ahead = rates.ahead,
                                            .internals = state_.internals});
  return std::exchange(state_, std::move(next));
}

void Whole::go_to(const Model& side, const State& state, std::vector<std::vector<double>> internals) {
  state_ = whole_of(side, state);
  state_.internals = std::move(internals);
}

}  // namespace plica
