// Picture of an undeformed mesh, coloured by one of its arrays.
#pragma once

#include <string>
#include <vector>

#include "show/picture.hpp"

namespace plica {

/// Names for colouring a mesh: its arrays and `region`.
std::vector<std::string> colours_of_mesh(const Frame& frame);

/// Describe the picture. `colour`: one of these names. Letters of named `axes` mark the ends.
Picture rest_picture(Frame frame, const std::string& colour, const std::vector<View>& views, const EmbryoAxes& axes);

}  // namespace plica
