// Colour fields and views by their names.
#pragma once

#include <algorithm>
#include <string>

#include "show/looks.hpp"

inline const plica::ColourField& field(const std::string& name) {
  return *std::ranges::find(plica::colour_fields(), name, &plica::ColourField::name);
}
inline const plica::View& view(const std::string& name) {
  return *std::ranges::find(plica::views(), name, &plica::View::name);
}
