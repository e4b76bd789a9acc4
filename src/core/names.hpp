// Names of the rows of a table, and of the entries of a map.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace plica {

inline constexpr auto every_row = [](const auto&) { return true; };

/// Names in the order of the table: all rows, or those for which `which` (member or function) is true.
template <class Rows, class Which = decltype(every_row)>
std::vector<std::string> names_of(const Rows& rows, Which which = every_row) {
  std::vector<std::string> names;
  for (const auto& row : rows)
    if (std::invoke(which, row)) names.emplace_back(row.name);
  return names;
}

template <class Map>
std::vector<std::string> keys_of(const Map& map) {
  std::vector<std::string> keys;
  keys.reserve(map.size());
  for (const auto& [key, value] : map) keys.push_back(key);
  return keys;
}

}  // namespace plica
