// Checks that need the tissue: missing faces, open surfaces, overlapping tables, inverted elements, empty holds.
#pragma once

#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Adds an error for the first element that is inverted or flat in the reference state.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors);

/// Runs all other checks on a tissue with resolved regions. Throws ScenarioError with all errors found.
void check_tissue(const Scenario& scenario, const Tissue& tissue);

/// Return a warning, with the `embryo.scale` that brings cells to um, if the median cell of a file (square root of the
/// apical area) is not 1 to 100 um wide; else nothing.
std::string unit_warning(const EmbryoInput& embryo, const Tissue& tissue);

}  // namespace plica
