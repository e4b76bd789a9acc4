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

struct BuiltinFile {
  std::string_view path;
  std::string_view text;
};

const std::vector<BuiltinScenario>& builtin_scenarios();

/// Measured tables that they build on: the files of scenarios/data/. A scenario names one builtin:NAME in place of a
/// path.
const std::vector<BuiltinTable>& builtin_tables();

/// Experiments and what lies beside them: scenarios/living/experiments.toml has the path living/experiments.toml.
const std::vector<BuiltinFile>& builtin_experiment_files();

inline constexpr std::string_view builtin_table_mark = "builtin:";
inline bool is_builtin_table(std::string_view path) { return path.starts_with(builtin_table_mark); }

}  // namespace plica
