// Loading of scenarios from TOML, with all errors reported at once.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"

namespace plica {

struct ScenarioSource {
  std::string name;  // built-in name or file stem
  std::string file;  // as shown in messages
  std::string text;
};

/// Finds a built-in by name, or reads a file; a built-in takes precedence over a file of the same name.
/// Throws UsageError if it is neither, FileError if the file cannot be read, ScenarioError if it is a mesh.
/// The message suggests built-in names, and files in the folder of the path, relative to `beside`.
ScenarioSource find_scenario(const std::string& name_or_path, const std::filesystem::path& beside = {});

/// Parses and validates a scenario. Keys of `base` come first, then the scenario's own, then `overrides`
/// ("dotted.key=value", the value in TOML syntax or a bare word). Throws ScenarioError with all errors at once.
Scenario load_scenario(const ScenarioSource& source, const std::vector<std::string>& overrides = {});

/// Errors of an override on its own, independent of a scenario: unknown key, wrong type, value out of range.
std::vector<Diagnostic> problems_of_override(const std::string& override);

}  // namespace plica
