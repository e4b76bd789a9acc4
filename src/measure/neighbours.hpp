// Measures of tissues whose cells exchange neighbours: set "neighbours". Shear is half the difference of logarithmic
// strains along the axis x and across it, in the surface of the sheet. It is that of triangles between the centres of
// three cells that meet (Merkel et al. 2017): their shapes change with the tissue until cells exchange neighbours.
#pragma once

#include <span>

#include "tissue/tissue.hpp"

namespace plica {

/// Return the mean shear of the triangles of some cells between two positions of the same tissue.
double shear_between(const Tissue& tissue, const CellSet& cells, std::span<const Vec3> before,
                     std::span<const Vec3> after);

/// Return the shear that makes equilateral triangles as long as these are, by the mean of their second moments.
double shape_shear(const Tissue& tissue, const CellSet& cells, std::span<const Vec3> positions);

}  // namespace plica
