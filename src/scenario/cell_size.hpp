// Whether coordinates of a file can be in um.
#pragma once

#include <string>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Return a warning, with the `embryo.scale` that brings cells to um, if the median cell of a file (square root of the
/// apical area) is not 1 to 100 um wide; else nothing.
std::string unit_warning(const EmbryoInput& embryo, const Tissue& tissue);

}  // namespace plica
