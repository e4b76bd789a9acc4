// What a tissue did in a run, in words that fit it: a furrow, a fold of a sheet, displacements, divisions.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// One line from the values of a summary: furrow depth and closure with ventral-dorsal axes, else the fold depth of a
/// sheet, the largest displacement and smallest apical area; cells, volume and lumen if they changed.
std::string outcome_text(const Scenario& scenario, const Tissue& tissue, const nlohmann::ordered_json& summary);

/// Since when a run self-intersects, and the remedy; empty if it does not.
std::string crossing_text(const Scenario& scenario, const nlohmann::ordered_json& summary);

}  // namespace plica
