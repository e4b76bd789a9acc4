// Scenario of a finished run, for pictures and pages.
#pragma once

#include <filesystem>
#include <optional>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Load scenario.toml of a run; empty if it is missing or of an incompatible version.
std::optional<Scenario> scenario_of_run(const std::filesystem::path& directory);

/// Returns the scenario with which to resume the run in a directory: values that neither file nor overrides set and
/// that are chosen automatically stay as the run began, whichever version chose them.
Scenario as_begun(Scenario scenario, const std::filesystem::path& directory);

/// Vitelline membrane of a run around the reference positions of nodes (um); empty if it has none.
std::optional<Capsule> shell_of_run(const Scenario& scenario, const Vectors& rest_positions);

}  // namespace plica
