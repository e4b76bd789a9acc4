// From a scenario to what is run: the model, and where the furrow is measured.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/furrow.hpp"
#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// The tissue of a scenario with its regions. Throws ScenarioError (an empty region, a mesh that cannot be used) or
/// FileError.
Tissue make_tissue(const Scenario& scenario);

/// The laws of a scenario on its tissue, the whole of it. Throws ScenarioError for what only the tissue shows to be
/// wrong.
std::unique_ptr<Model> make_model(const Scenario& scenario);

/// The part of a symmetric embryo that is solved, and what of the whole it stands for.
struct SolvedSide {
  std::unique_ptr<Model> model;
  Mirror mirror;
};

/// Of the scenario's whole model; nothing where it has no mirror planes. Throws ScenarioError for what is not
/// symmetric.
std::optional<SolvedSide> make_solved_side(const Scenario& scenario, const Model& whole);

/// The regions on which contractions act, the largest first: without [furrow], that is where the furrow is measured.
std::vector<std::string> contracting_regions(const Scenario& scenario, const Tissue& tissue);

/// VML, VCE, midline and lips of the scenario's furrow; none where there is no contraction.
FurrowSites make_furrow_sites(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
