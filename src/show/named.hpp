// Choice by name in options.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "scenario/suggest.hpp"

namespace plica {

/// Find the view or quantity of a name. Throws UsageError that lists all names.
template <class Thing>
const Thing& named(const char* option, const std::string& name, const std::vector<Thing>& things) {
  const auto found = std::ranges::find(things, name, &Thing::name);
  if (found != things.end()) return *found;
  const std::vector<std::string> names = names_of(things);
  const auto nearest = nearest_name(name, names);
  throw UsageError(fmt::format("{} {}: unknown name; {}available: {}", option, name,
                               nearest ? fmt::format("use {} (nearest match); ", *nearest) : "",
                               fmt::join(names, ", ")));
}

}  // namespace plica
