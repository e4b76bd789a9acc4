// From TOML to a Scenario, or to everything that is wrong with it.
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

/// Finds a built-in by name, or reads a file; a built-in goes before a file of the same name.
/// Throws UsageError where it is neither, FileError where the file cannot be read.
/// The message suggests built-in names, and files that lie beside the path or in the folder `beside`.
ScenarioSource find_scenario(const std::string& name_or_path, const std::filesystem::path& beside = {});

/// Parses and validates a scenario. Keys of `base` come first, then the scenario's own, then `overrides`
/// ("dotted.key=value", the value in TOML syntax or a bare word). Throws ScenarioError with all errors at once.
Scenario load_scenario(const ScenarioSource& source, const std::vector<std::string>& overrides = {});

/// What is wrong with an override by itself, whatever the scenario: an unknown key, a value of a wrong type or out of
/// range.
std::vector<Diagnostic> problems_of_override(const std::string& override);

}  // namespace plica
