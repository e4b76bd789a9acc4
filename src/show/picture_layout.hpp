// Layout of a picture, in pixels from its left and lower edge; and the contents of its panels as triangles and lines.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "show/picture.hpp"

namespace plica {

struct Box {
  double left = 0, bottom = 0, width = 0, height = 0;
};

/// Panel that shows an embryo, with the origin at its centre.
struct Panel {
  Box box;
  std::size_t column = 0, row = 0;
};

/// Line of text; (`x`, `y`): middle of its height, and its left end or the middle of its width.
struct Label {
  std::string text;
  double x = 0, y = 0;
  double size_px = 12;
  bool is_centred = true;
  bool bold = false;
  bool upwards = false;  // rotated by 90 degrees
};

struct Rectangle {
  Box box;
  Rgb colour;
};

struct Layout {
  int width_px = 0, height_px = 0;
  double um_per_px = 1;  // of all panels
  double font_px = 12;   // of most labels: above 7 points for a print width of 16 cm
  std::vector<Panel> panels;
  std::vector<Rectangle> rectangles;  // later ones cover earlier ones
  std::vector<Label> labels;
};

/// Compute the layout. Throws UsageError for too small a size.
Layout make_layout(const Picture& picture);

/// Ticks within a range: multiples of 1, 2, 2.5 or 5 times a power of ten, at least two and at most `most`.
std::vector<double> scale_ticks(const ColourRange& range, int most);

/// Largest of 1, 2 and 5 times a power of ten not above `value`.
double round_length(double value);

/// Break a text between words into lines of at most `most` letters; longer words are kept.
std::vector<std::string> wrapped(const std::string& text, std::size_t most);

using Segment = std::array<Vec3, 2>;

/// Content of a panel, in coordinates of the embryo; triangles are three consecutive corners, symmetric for a symmetric
/// embryo.
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
