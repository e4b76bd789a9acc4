// Errors of a study's scenario, located in the study's file.
#pragma once

#include "core/errors.hpp"
#include "study/design.hpp"
#include "study/study_input.hpp"

namespace plica {

/// Relocate errors to the keys of [set] and [vary] that cause them.
ScenarioError in_study(const ScenarioError& error, const StudyInput& study);

/// Throw ScenarioError if a value of the design, or a bound of a key, has the wrong type or is out of range, whatever
/// the other values.
void require_values_of_keys(const StudyInput& study, const StudyDesign& design);

/// Throw ScenarioError if a listed value gives no valid scenario in any run. At least one run must be valid.
void require_usable_values(const StudyInput& study, const StudyDesign& design);

}  // namespace plica
