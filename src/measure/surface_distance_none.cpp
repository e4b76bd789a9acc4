// Replacement of surface_distance_vtk.cpp for builds without VTK.
#ifndef PLICA_WITH_VTK

#include "core/errors.hpp"
#include "measure/surface_distance.hpp"

namespace plica {

struct SurfaceDistance::Search {};

SurfaceDistance::SurfaceDistance(const TriangleSurface&) {
  throw FileError(
      "distances to a surface are not available (built without VTK); in Python: pip install pyvista, and "
      "plica.compare(A, B).surface");
}

SurfaceDistance::~SurfaceDistance() = default;

double SurfaceDistance::from(const Vec3&) const { return 0; }

}  // namespace plica

#endif
