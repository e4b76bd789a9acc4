// The scenario of a finished run, as pictures and pages need it.
#pragma once

#include <filesystem>
#include <optional>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// `directory`'s scenario.toml; nothing where the file is gone, or another version of plica wrote what this one does
/// not read.
std::optional<Scenario> scenario_of_run(const std::filesystem::path& directory);

/// The vitelline shell that a run of the scenario has around the nodes at rest (um); nothing where it has none.
std::optional<Capsule> shell_of_run(const Scenario& scenario, const Vectors& rest_positions);

}  // namespace plica
