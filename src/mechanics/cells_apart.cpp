#include "mechanics/cells_apart.hpp"

#include <algorithm>

#include "mechanics/division.hpp"
#include "mechanics/energy.hpp"
#include "tissue/mirror.hpp"

namespace plica {
namespace {

Tissue part_of(const Tissue& tissue, const CellSet& cells, TissueChange& kept) {
  Tissue part = tissue;
  kept = keep_only(part, cells);
  return part;
}

}  // namespace

// Without new cells and nodes, laws do not depend on the positions.
CellsApart::CellsApart(const Model& model, const Vectors& positions, const CellSet& cells)
    : revision_(model.revision), part_(part_of(model.tissue, cells, kept_)) {
  part_.volumes = model.volumes.divided(part_.tissue, kept_);
  for (const auto& law : model.laws) {
    part_.laws.push_back(law->after_change(part_.tissue, kept_, positions));
    part_.laws.back()->set_label(law->label());
  }
  for (const auto& constraint : model.constraints)
    part_.constraints.push_back(constraint->after_change(part_.tissue, kept_, positions));
}

CellId CellsApart::number_of(CellId cell) const {
  const auto found = std::ranges::lower_bound(kept_.origin, cell);
  return found == kept_.origin.end() || *found != cell ? CellId()
                                                       : CellId(static_cast<std::size_t>(found - kept_.origin.begin()));
}

State CellsApart::state(const Model& whole, const State& state) const {
  State part;
  part.time_s = state.time_s;
  part.positions = state.positions;
  part.velocities = state.velocities;
  part.multipliers = multipliers_after(whole, state.multipliers, kept_);
  for (std::size_t l = 0; l < whole.laws.size(); ++l)
    part.internals.push_back(whole.laws[l]->internal_after_change(state.internals[l], part_.tissue, kept_, {}));
  return part;
}

Vectors CellsApart::forces(const Model& whole, const State& state) const {
  const State part = this->state(whole, state);
  const Vectors no_velocity(state.positions.size(), Vec3::Zero());
  Vectors forces(state.positions.size(), Vec3::Zero());
  for_laws(part_, motionless(part, no_velocity),
           [&](const Law& law, const Step& step) { law.add_forces(step, forces); });
  part_.volumes.add_forces(state.positions, part.pressures(part_), forces);
  part_.tissue.carry_hanging(forces);
  return forces;
}

}  // namespace plica
