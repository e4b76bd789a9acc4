// What needs the tissue: cells of regions (tables/region.cpp), and checks for missing faces, open surfaces, overlapping
// tables, inverted elements, empty holds, asymmetry about mirror planes.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"
#include "tissue/mirror.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Fills `tissue.regions`. Adds errors that depend on the embryo (empty regions, missing arrays). References and cycles
/// have been checked by load_scenario.
void add_regions(const Scenario& scenario, Tissue& tissue, std::vector<Diagnostic>& errors);

/// Makes an error at the place of `key`, or of the nearest enclosing table, in the scenario's file.
Diagnostic diagnostic_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy);

/// Throws ScenarioError with this error alone.
[[noreturn]] void throw_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy);

/// Makes the error that the tissue lacks an array which `key` names.
Diagnostic no_array(const Scenario& scenario, const std::string& key, const std::string& array, const Tissue& tissue);

/// Adds an error unless the tissue has the array that `key` names, with a finite value in every cell of the region.
void check_array(const Scenario& scenario, const std::string& key, const std::string& name, const std::string& region,
                 const Tissue& tissue, std::vector<Diagnostic>& errors);

/// Adds an error for the first element that is inverted or flat in the reference state.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors);

/// Runs all other checks on a tissue with resolved regions. Throws ScenarioError with all errors found.
void check_tissue(const Scenario& scenario, const Tissue& tissue);

/// Return a warning, with the `embryo.scale` that brings cells to um, if the median cell of a file (square root of the
/// apical area) is not 1 to 100 um wide; else nothing.
std::string unit_warning(const EmbryoInput& embryo, const Tissue& tissue);

/// Returns the solved side of the scenario's mirror planes (at least one). Throws ScenarioError if the tissue, or input
/// on its cells and nodes, is not symmetric.
MirroredSide mirrored_side(const Scenario& scenario, const Tissue& whole);

}  // namespace plica
