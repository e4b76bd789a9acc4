// A picture of a mesh at rest, coloured by one of its arrays.
#pragma once

#include <string>
#include <vector>

#include "show/picture.hpp"

namespace plica {

/// The names by which a mesh can be coloured: its arrays, and `region`.
std::vector<std::string> colours_of_mesh(const Frame& frame);

/// `colour`: one of these. `is_embryo`: its ends and sides have letters.
Picture rest_picture(Frame frame, const std::string& colour, const std::vector<View>& views, bool is_embryo);

}  // namespace plica
