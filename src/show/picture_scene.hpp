// What a panel of a picture shows, as triangles and lines in the embryo's own coordinates.
#pragma once

#include <array>
#include <vector>

#include "show/picture.hpp"

namespace plica {

using Segment = std::array<Vec3, 2>;

/// Triangles are three corners after each other; a symmetric embryo gives symmetric ones.
struct Scene {
  Vectors corners, normals;       // um; a facet's triangles have one normal
  std::vector<double> values;     // of the field, a corner each
  bool lit = true;                // light and shade; without them, colours are those of the legend
  std::vector<Segment> outlines;  // of cells
  std::vector<Segment> rest;      // outline of the embryo at rest, in sections
  Vectors shell;                  // triangles of a band around the embryo
};

/// The outer facets of a frame, or for a view that cuts, the section alone. FileError when the frame lacks the field.
/// `band_um`: how thick the shell is drawn.
Scene make_scene(const Picture& picture, const PictureColumn& column, const View& view, double band_um);

/// Unit vectors of a view: to the right and upwards in the picture.
struct Screenwise {
  Vec3 right, up;
};
Screenwise screenwise(const View& view);

}  // namespace plica
