#include "mechanics/model.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/errors.hpp"
#include "mechanics/cell_stress.hpp"

namespace plica {

Model::Model(Tissue t) : tissue(std::move(t)), volumes(tissue), held(tissue.node_count(), {false, false, false}) {}

Model::Model(const Model& other, Tissue t, std::span<const ElementId> reshaped, std::span<const GrowthTensor> tensors)
    : tissue(std::move(t)),
      volumes(other.volumes.grown(tissue)),
      signals(other.signals),
      held(other.held),
      growths(other.growths),
      stiffness_scale(other.stiffness_scale) {
  for (const auto& law : other.laws) {
    laws.push_back(law->grown(tissue, reshaped, tensors));
    laws.back()->set_label(law->label());
  }
  for (const auto& constraint : other.constraints) constraints.push_back(constraint->clone());
  for (const auto& obstacle : other.obstacles) obstacles.push_back(obstacle->clone());
}

std::size_t Model::multiplier_count() const {
  std::size_t count = volumes.count();
  for (const auto& constraint : constraints) count += constraint->count();
  return count;
}

std::span<const double> Model::masses() const {
  for (const auto& law : laws)
    if (const auto masses = law->masses(); !masses.empty()) return masses;
  return {};
}

double Model::force_scale() const {
  double volume = 0;
  for (const double target : volumes.targets()) volume += target;
  return stiffness_scale * std::pow(volume / static_cast<double>(tissue.elements.size()), 2.0 / 3);
}

double Model::position_rounding() const {
  double extent = 0;
  for (const Vec3& position : tissue.rest_positions) extent = std::max(extent, position.norm());
  return 16 * std::numeric_limits<double>::epsilon() * extent;
}

double Model::elastic_rounding() const {
  // Stiffness of a slab, E A / height = E A^2 / V, A its largest face, times the rounding of a position, over all
  // nodes.
  double thinnest = 0;
  for (const HexPoints& rest : tissue.element_rest_shape) {
    const double area = largest_face(rest);
    thinnest = std::max(thinnest, area / hex_volume(rest) * area);
  }
  return stiffness_scale * thinnest * position_rounding() * std::sqrt(static_cast<double>(tissue.node_count()));
}

std::size_t place_of_law(const Model& model, const std::string& label, bool acting) {
  std::vector<std::string> labels;
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    if (acting && !model.laws[l]->is_active()) continue;
    labels.push_back(model.laws[l]->label());
    if (labels.back() == label) return l;
  }
  throw UsageError(fmt::format("{} \"{}\"; {}: {}", acting ? "no active law" : "no law", label,
                               acting ? "active laws" : "laws", fmt::join(labels, ", ")));
}

std::vector<std::vector<double>> next_internals(const Model& model, const Step& step) {
  std::vector<std::vector<double>> internals;
  for_laws(model, step,
           [&](const Law& law, const Step& law_step) { internals.push_back(law.next_internal(law_step)); });
  return internals;
}

std::optional<SignalFailure> advance_signals(const Model& model, const State& before, State& after) {
  after.signals = before.signals;
  if (!model.signals.empty()) {
    const std::vector<double> volumes_before = model.volumes.volumes(before.positions),
                              volumes = model.volumes.volumes(after.positions);
    if (auto failure = model.signals.advance(model.tissue, {volumes_before, volumes, after.positions},
                                             after.time_s - before.time_s, after.signals))
      return failure;
  }
  follow_signals(model, after);
  return std::nullopt;
}

void follow_signals(const Model& model, State& state) {
  Signals::Values signals = state.signals;
  if (reads_stress(model)) signals.push_back(passive_stresses(model, state));
  if (signals.empty()) return;
  for (std::size_t l = 0; l < model.laws.size(); ++l)
    state.internals[l] = model.laws[l]->with_signals(state.internals[l], signals, state.time_s);
}

State rest_state(const Model& model) {
  State state;
  state.positions = model.tissue.rest_positions;
  state.velocities.assign(model.tissue.node_count(), Vec3::Zero());
  state.multipliers.assign(model.multiplier_count(), 0.0);
  const ObstacleContacts contacts(model);
  state.obstacle_forces.assign(contacts.size(), 0.0);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    state.on_obstacle.push_back(contacts.gap(k, state.positions).value <= 1e-9);
  for (const auto& law : model.laws) state.internals.push_back(law->first_internal(model.tissue));
  state.signals = model.signals.initial();
  follow_signals(model, state);
  return state;
}

}  // namespace plica
