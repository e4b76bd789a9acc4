// Cells, nodes and elements affected by a scenario table, on a tissue with resolved regions.
#pragma once

#include <vector>

#include "mechanics/active/cell_pattern.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Per-cell activation of a table: region, amplitude factors, delays and pulses (pressures and elasticity: factors
/// only).
CellPattern make_pattern(const ContractionInput& input, const Tissue& tissue);
CellPattern make_pattern(const CortexInput& input, const Tissue& tissue);
CellPattern make_pattern(const PressureInput& input, const Tissue& tissue);
CellPattern make_pattern(const RegionElasticityInput& input, const Tissue& tissue);

/// Whether an ablation affects `table` (cortex.NAME or contraction.NAME), which acts on `faces` or their edges.
bool takes_from(const AblationInput& ablation, const std::string& table, const std::string& faces);

/// Ablations of the scenario that affect this table.
std::vector<Ablation> make_ablations(const Scenario& scenario, const std::string& table, const std::string& faces,
                                     const Tissue& tissue);

/// Longest time step that resolves the pulses (s).
inline double longest_step_of_pulses_s(const PulseInput& pulse) { return *pulse.period_s / (12 * (1 + pulse.spread)); }

/// Fixed nodes of a [hold.NAME] table; one entry per node.
std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue);

/// Elastic properties of one element.
struct ElasticMaterial {
  double factor = 1;  // on the Young's modulus of [elasticity]
  double poisson_ratio = 0;
  double relaxation_s = 0;  // 0: none
};

/// Elements affected by a table: those of `cells` with their centre in `height_percent`. One entry per element.
std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue);

/// Overwrites `materials` of the affected elements; `pattern` is that of the table on this tissue.
void put_material(const RegionElasticityInput& input, const ElasticityInput& common, const CellPattern& pattern,
                  const Tissue& tissue, std::vector<ElasticMaterial>& materials);

}  // namespace plica
