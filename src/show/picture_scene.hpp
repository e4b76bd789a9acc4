// Content of a panel as triangles and lines, in coordinates of the embryo.
#pragma once

#include <array>
#include <vector>

#include "show/picture.hpp"

namespace plica {

using Segment = std::array<Vec3, 2>;

/// Scene; triangles are three consecutive corners, symmetric for a symmetric embryo.
struct Scene {
  Vectors corners, normals;       // um; triangles of a facet share a normal
  std::vector<double> values;     // of the field; corners
  bool lit = true;                // shading; without it, colours equal the legend
  std::vector<Segment> outlines;  // of cells
  std::vector<Segment> rest;      // reference outline, in sections
  Vectors shell;                  // triangles of a band around the embryo
};

/// Scene of the boundary surface of a snapshot or, for a section view, the section alone. `band_um`: thickness of the
/// shell. Throws FileError for a missing field.
Scene make_scene(const Picture& picture, const PictureColumn& column, const View& view, double band_um);

/// Unit vectors of a view, rightward and upward in the picture.
struct Screenwise {
  Vec3 right, up;
};
Screenwise screenwise(const View& view);

}  // namespace plica
