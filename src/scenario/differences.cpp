#include "scenario/differences.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <map>
#include <sstream>

namespace plica {
namespace {

using Values = std::map<std::string, std::string>;  // by dotted key

void flatten(const toml::table& table, const std::string& path, Values& values) {
  for (const auto& [key, node] : table) {
    const std::string here = path + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, here + ".", values);
      continue;
    }
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    values[here] = text.str();
  }
}

Values values_of(std::string_view text) {
  Values values;
  try {
    flatten(toml::parse(text), "", values);
  } catch (const toml::parse_error&) {
  }
  return values;
}

}  // namespace

std::string KeyDifference::text() const {
  const auto shown = [](const std::string& value) { return value.empty() ? "missing" : value; };
  return fmt::format("{} was {} and is now {}", key, shown(a), shown(b));
}

std::vector<KeyDifference> scenario_differences(std::string_view a, std::string_view b) {
  std::map<std::string, KeyDifference> all;
  for (const auto& [key, value] : values_of(a)) all[key].a = value;
  for (const auto& [key, value] : values_of(b)) all[key].b = value;
  std::vector<KeyDifference> differences;
  for (const auto& [key, values] : all)
    if (values.a != values.b) differences.push_back({key, values.a, values.b});
  return differences;
}

}  // namespace plica
