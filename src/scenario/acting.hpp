// Which cells and nodes a table of the scenario is about, on a tissue that has its regions.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Who acts, how strongly and how late; or of which cells something else is told, with a factor on it.
CellPattern make_pattern(const ContractionInput& input, const Tissue& tissue);
CellPattern make_pattern(const CortexInput& input, const Tissue& tissue);
CellPattern make_pattern(const PressureInput& input, const Tissue& tissue);
CellPattern make_pattern(const RegionElasticityInput& input, const Tissue& tissue);

/// Whether an ablation takes from a table, cortex.NAME or contraction.NAME, that acts on these faces, or their edges.
bool takes_from(const AblationInput& ablation, const std::string& table, const std::string& faces);

/// What the scenario takes away from cells' strength in that table.
std::vector<Ablation> make_ablations(const Scenario& scenario, const std::string& table, const std::string& faces,
                                     const Tissue& tissue);

/// The longest step that sees pulses, s.
inline double longest_step_of_pulses_s(const PulseInput& pulse) { return *pulse.period_s / (12 * (1 + pulse.spread)); }

/// The nodes of a hold.
std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue);

}  // namespace plica
