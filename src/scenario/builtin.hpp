// The scenarios that plica carries within itself: the files of scenarios/, put in at build time.
#pragma once

#include <string_view>
#include <vector>

namespace plica {

struct BuiltinScenario {
  std::string_view name;
  std::string_view toml;
};

struct BuiltinTable {
  std::string_view name;
  std::string_view csv;
};

const std::vector<BuiltinScenario>& builtin_scenarios();

/// Measured tables that they build on: the files of scenarios/data/. A scenario names one builtin:NAME in place of a
/// path.
const std::vector<BuiltinTable>& builtin_tables();

inline constexpr std::string_view builtin_table_mark = "builtin:";
inline bool is_builtin_table(std::string_view path) { return path.starts_with(builtin_table_mark); }

}  // namespace plica
