// Where everything stands in a picture, in pixels from its left and lower edge.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "show/picture.hpp"

namespace plica {

struct Box {
  double left = 0, bottom = 0, width = 0, height = 0;
};

/// A part of the picture that shows an embryo, whose origin is in its middle.
struct Panel {
  Box box;
  std::size_t column = 0, row = 0;
};

enum class Align { left, centre, right };

/// A line of text; `x`, `y` is the middle of its height, and of its width as `align` has it.
struct Label {
  std::string text;
  double x = 0, y = 0;
  double size_px = 12;
  Align align = Align::centre;
  bool bold = false;
  bool upwards = false;  // turned by a quarter, to read from below
};

struct Rectangle {
  Box box;
  Rgb colour;
};

struct Layout {
  int width_px = 0, height_px = 0;
  double um_per_px = 1;  // of all panels
  double font_px = 12;   // of most labels: over 7 points when the picture is printed 16 cm wide
  std::vector<Panel> panels;
  std::vector<Rectangle> rectangles;  // later ones cover earlier ones
  std::vector<Label> labels;
};

/// UsageError when the size asked for is too small to hold anything.
Layout make_layout(const Picture& picture);

/// Multiples of 1, 2, 2.5 or 5 times a power of ten within a range, at most `most` of them; at least two.
std::vector<double> scale_ticks(const ColourRange& range, int most);

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
double round_length(double value);

/// A text in lines of at most `most` letters, broken between words; a longer word stays whole.
std::vector<std::string> wrapped(const std::string& text, std::size_t most);

}  // namespace plica
