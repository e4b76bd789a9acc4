// Reading of one TOML document into a Scenario, key by key, according to its tables (tables/).
#pragma once

#include <toml++/toml.h>

#include <string>

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

struct Layer {
  std::string file;       // as shown in messages
  int number = 0;         // later layers override earlier ones
  bool has_lines = true;  // not on the command line
};

/// Fills the fields set in `table` and records their places; reports unknown keys and values that are not allowed.
void read_layer(const toml::table& table, const Layer& layer, Scenario& scenario, Input& input);

/// Whether `name` is valid for a region, a contraction, ...: letters, digits, "_" and "-".
bool is_plain_name(std::string_view name);

}  // namespace plica
