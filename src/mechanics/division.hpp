// Cell division between steps: changes of model and state. The cut itself: tissue/division.hpp.
// Theory: docs/theory/division.md.
#pragma once

#include <functional>
#include <span>

#include "mechanics/model.hpp"
#include "tissue/division.hpp"

namespace plica {

/// Order to divide one cell.
struct PlannedDivision {
  CellCut cut;
  double growth_s = 0;      // from cut to final size of the daughters; 0: immediate
  double volume_ratio = 1;  // final volume of a daughter / volume of the mother
};

/// Makes a change of a run again, whatever forces say, for a model and a state of the same tissue. Returns false if its
/// cells would get poor elements, in contrast to the run.
using RepeatedChange = std::function<bool(Model&, State&)>;

/// Divide the cells at the time of the state. Positions, momentum and tension of contractions do not change; pressures
/// and velocities are inherited. The target volume of a daughter starts at the volume of its half, its rest shape at
/// half of that of the mother; both then grow (`grown`). std::logic_error if the tissue is indivisible.
TissueChange divide_cells(Model& model, State& state, std::span<const PlannedDivision> planned);

/// Let model and state follow a change of their tissue, whose positions the state has; `before`: those before it.
void follow_change(Model& model, State& state, const TissueChange& change, const Vectors& before);

/// Return multipliers after a change, called on the model before it.
std::vector<double> multipliers_after(const Model& model, std::span<const double> multipliers,
                                      const TissueChange& change);

/// Take the rest shapes, target volumes and rest areas of growing cells at the time of the state, and drop growth that
/// has ended. A change of the tissue must follow, from which laws count growth again.
void settle_growth(Model& model, const State& state);

}  // namespace plica
