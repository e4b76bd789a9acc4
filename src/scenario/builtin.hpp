// Built-in scenarios: the files of scenarios/, embedded at build time.
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

/// Measured tables used by built-in scenarios: the files of scenarios/data/. A scenario refers to one as builtin:NAME
/// in place of a path.
const std::vector<BuiltinTable>& builtin_tables();

/// Experiment files and their tables, by path below scenarios/ (living/experiments.toml), and work.csv.
const std::vector<BuiltinFile>& builtin_experiment_files();

inline constexpr std::string_view builtin_table_mark = "builtin:";
inline bool is_builtin_table(std::string_view path) { return path.starts_with(builtin_table_mark); }

}  // namespace plica
