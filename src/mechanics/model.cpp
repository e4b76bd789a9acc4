#include "mechanics/model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plica {

double Growth::part(double time_s) const {
  if (time_s >= end_s) return 1;
  return time_s <= start_s ? 0 : (time_s - start_s) / (end_s - start_s);
}

Model::Model(const Model& other)
    : tissue(other.tissue),
      volumes(other.volumes),
      volumes_are_held(other.volumes_are_held),
      vitelline(other.vitelline),
      held(other.held),
      growths(other.growths),
      stiffness_scale(other.stiffness_scale) {
  for (const auto& law : other.laws) laws.push_back(law->clone());
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

namespace {

// Distance that positions are rounded by, um, with a margin for sums.
double position_rounding(const Tissue& tissue) {
  double extent = 0;
  for (const Vec3& position : tissue.rest_positions) extent = std::max(extent, position.norm());
  return 16 * std::numeric_limits<double>::epsilon() * extent;
}

// Largest of an element's faces, um^2, over its volume: how much a shift of a face changes it.
double thinnest(const Tissue& tissue, bool times_face) {
  double most = 0;
  for (const HexPoints& rest : tissue.element_rest_shape) {
    double face_area = 0;
    for (const auto& face : hex_faces)
      face_area = std::max(face_area, facet_area({rest[face[0]], rest[face[1]], rest[face[2]], rest[face[3]]}));
    most = std::max(most, face_area / hex_volume(rest) * (times_face ? face_area : 1));
  }
  return most;
}

}  // namespace

double Model::force_rounding() const {
  // Stiffness of a slab, E A / height = E A^2 / V, times the rounding of a position, over all nodes.
  return stiffness_scale * thinnest(tissue, true) * position_rounding(tissue) *
         std::sqrt(static_cast<double>(tissue.node_count()));
}

double Model::volume_rounding() const { return thinnest(tissue, false) * position_rounding(tissue); }

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
