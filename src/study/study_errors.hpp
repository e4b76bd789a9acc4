// What is wrong with a study's scenario, in the lines of the study's file.
#pragma once

#include "core/errors.hpp"
#include "study/design.hpp"
#include "study/study_input.hpp"

namespace plica {

/// The same errors at the keys of [set] and [vary] that they come from.
ScenarioError in_study(const ScenarioError& error, const StudyInput& study);

/// ScenarioError where a value of the design is none of its key, whatever the others are: of a wrong type, or out of
/// range. Of keys between bounds that holds for the bounds, too.
void require_values_of_keys(const StudyInput& study, const StudyDesign& design);

/// ScenarioError where a value that the study lists makes no scenario in any run. At least one run has to be valid.
void require_usable_values(const StudyInput& study, const StudyDesign& design);

}  // namespace plica
