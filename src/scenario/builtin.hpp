// The scenarios that plica carries within itself: the files of scenarios/, put in at build time.
#pragma once

#include <string_view>
#include <vector>

namespace plica {

struct BuiltinScenario {
  std::string_view name;
  std::string_view toml;
};

const std::vector<BuiltinScenario>& builtin_scenarios();

}  // namespace plica
