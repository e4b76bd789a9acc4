// Options shared by all commands that take a scenario.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "scenario/load.hpp"

namespace plica {

struct ScenarioOptions {
  std::string name_or_path;
  std::vector<std::string> overrides;

  void add_to(CLI::App& command) {
    command.add_option("SCENARIO", name_or_path, "TOML file, or built-in name (`plica scenarios`)")->required();
    command.add_option("--set", overrides, "KEY=VALUE: override a key of the scenario; repeatable")
        ->allow_extra_args(false);
  }
  [[nodiscard]] Scenario load() const { return load_scenario(find_scenario(name_or_path), overrides); }
};

}  // namespace plica
