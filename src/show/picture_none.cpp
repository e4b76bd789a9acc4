// What stands in for picture_vtk.cpp when plica is built without VTK.
#ifndef PLICA_WITH_VTK

#include "core/errors.hpp"
#include "show/picture.hpp"

namespace plica {

struct Painter::Screen {};

Painter::Painter() { throw FileError("pictures cannot be drawn: plica was built without VTK"); }
Painter::~Painter() = default;
std::string Painter::png(const Picture&) { return ""; }

}  // namespace plica

#endif
