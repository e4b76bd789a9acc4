// Names of the ends of the coordinate axes ([embryo] axes): anatomical for embryos, x, y and z for other tissues.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"

namespace plica {

/// Names of the low and the high end of x, y and z.
using EmbryoAxes = std::array<std::array<std::string, 2>, 3>;

/// Anterior to posterior, left to right, ventral to dorsal; and −x to +x, −y to +y, −z to +z.
const EmbryoAxes& anatomical_axes();
const EmbryoAxes& plain_axes();

/// Axes of a tissue: those of the scenario, or by its shape.
EmbryoAxes axes_of(const EmbryoInput& embryo);

/// Whether results are described as a ventral furrow.
bool have_furrow(const EmbryoAxes& axes);

/// Letters for the ends in pictures: the shortest distinct beginnings of the names.
EmbryoAxes letters_of(const EmbryoAxes& axes);

/// Problem of a list of axes ("low-high" or one word, for x, y and z); empty if there is none.
std::string axes_problem(const std::vector<std::string>& axes);

}  // namespace plica
