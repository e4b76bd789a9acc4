// Things that options choose by name.
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

/// The view or quantity of that name.
template <class Thing>
const Thing& named(const char* option, const std::string& name, const std::vector<Thing>& things) {
  const auto found = std::ranges::find(things, name, &Thing::name);
  if (found != things.end()) return *found;
  const std::vector<std::string> names = names_of(things);
  const auto nearest = nearest_name(name, names);
  throw UsageError(fmt::format("{} {}: there is none of that name; {}there are: {}", option, name,
                               nearest ? fmt::format("did you mean {}? ", *nearest) : "", fmt::join(names, ", ")));
}

}  // namespace plica
