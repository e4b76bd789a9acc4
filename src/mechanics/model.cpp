#include "mechanics/model.hpp"

#include <cmath>

namespace plica {

double Model::force_scale() const {
  double volume = 0;
  for (const double target : volumes.targets()) volume += target;
  return stiffness_scale * std::pow(volume / static_cast<double>(tissue.elements.size()), 2.0 / 3);
}

State rest_state(const Model& model) {
  State state;
  state.positions = model.tissue.rest_positions;
  state.velocities.assign(model.tissue.node_count(), Vec3::Zero());
  state.pressures.assign(model.volumes.count(), 0.0);
  if (model.vitelline) {
    state.contact_forces.assign(model.vitelline->nodes().size(), 0.0);
    for (const NodeId node : model.vitelline->nodes())
      state.in_contact.push_back(model.vitelline->gap(state.positions[node.index()]).value <= 1e-9);
  }
  return state;
}

}  // namespace plica
