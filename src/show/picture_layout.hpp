// Layout of a picture, in pixels from its left and lower edge.
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

}  // namespace plica
