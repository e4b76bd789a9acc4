// Construction of the model of a scenario, and of what its run measures and when it stops.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "measure/furrow.hpp"
#include "measure/observation.hpp"
#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"

namespace plica {

/// Builds the tissue of a scenario with its regions. Throws ScenarioError (empty region, unusable mesh) or FileError.
Tissue make_tissue(const Scenario& scenario);

/// Builds the whole tissue and its force laws. Throws ScenarioError for errors that depend on the tissue.
std::unique_ptr<Model> make_model(const Scenario& scenario);

/// Fixes a node and its periodic original along `axis`.
void hold_node(NodeId node, int axis, Model& model);

/// Solved part of a symmetric embryo, and its mapping to the whole.
struct SolvedSide {
  std::unique_ptr<Model> model;
  Mirror mirror;
};

/// Builds the solved part of a whole model; nothing without mirror planes. Throws ScenarioError for asymmetric input.
std::optional<SolvedSide> make_solved_side(const Scenario& scenario, const Model& whole);

/// Contracting regions, the largest first; by default, the furrow is measured on the first.
std::vector<std::string> contracting_regions(const Scenario& scenario, const Tissue& tissue);

/// VML, VCE, midline and lips of the scenario's furrow; empty without contraction.
FurrowSites make_furrow_sites(const Scenario& scenario, const Tissue& tissue);

/// Sets `vitelline.enabled` of shape "file", unless given, to whether the tissue is closed: its apical surface has no
/// boundary, that is, every edge of it belongs to two facets. Reads the mesh; its errors are left to make_tissue.
/// Throws ScenarioError if an open tissue is given a drag along the membrane.
void set_default_shell(Scenario& scenario);

/// Begins the measure sets, makes monitors in the order of their names, opens their references, and makes the stop
/// criteria. `model`: of the whole tissue. Throws ScenarioError for errors that depend on the tissue or on files.
MeasurePlan make_measure_plan(const Scenario& scenario, const Model& model);

}  // namespace plica
