#include "mechanics/cell_stress.hpp"

#include <algorithm>

#include "mechanics/active/cortex.hpp"
#include "mechanics/energy.hpp"

namespace plica {
namespace {

Vec3 axis_to_apex(const Cell& cell, std::span<const Vec3> positions) {
  Vec3 axis = Vec3::Zero();
  for (std::size_t i = 0; i < cell.sides(); ++i)
    axis += positions[cell.corners[i + cell.sides()].index()] - positions[cell.corners[i].index()];
  return axis.normalized();
}

}  // namespace

bool reads_stress(const Model& model) {
  return std::ranges::any_of(model.laws,
                             [](const auto& law) { return law->cortex() && law->cortex()->reads_stress(); });
}

std::vector<double> passive_stresses(const Model& model, const State& state) {
  const Vectors no_velocity(state.positions.size(), Vec3::Zero());
  std::vector<Mat3> integrals(model.tissue.cells.size(), Mat3::Zero());
  for_laws(model, motionless(state, no_velocity),
           [&](const Law& law, const Step& step) { law.add_stress_integrals(step, integrals); });
  std::vector<double> stresses = model.volumes.volumes(state.positions);
  for (std::size_t c = 0; c < stresses.size(); ++c) {
    const Vec3 n = axis_to_apex(model.tissue.cells[c], state.positions);
    const double along = n.dot(integrals[c] * n), in_plane = 0.5 * (integrals[c].trace() - along);
    stresses[c] = (in_plane - along) / stresses[c];
  }
  return stresses;
}

}  // namespace plica
