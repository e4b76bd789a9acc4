// Replacement of picture_vtk.cpp for builds without VTK.
#ifndef PLICA_WITH_VTK

#include "core/errors.hpp"
#include "show/picture.hpp"

namespace plica {

struct Painter::Screen {};

Painter::Painter() {
  throw FileError(
      "pictures are not available (built without VTK); in Python: pip install pyvista, and plica.render(DIR, FILE)");
}
Painter::~Painter() = default;
std::string Painter::png(const Picture&) { return ""; }

}  // namespace plica

#endif
