// SVG output of the shapes that plots need.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace plica {

/// Position in a picture: pixels from its left and upper edge.
using Pixel = std::array<double, 2>;

/// Style and alignment of text.
struct TextStyle {
  double size = 12;
  std::string anchor = "start";  // start | middle | end
  bool bold = false;
  bool upwards = false;  // rotated by 90 degrees
};

/// SVG picture on white; later shapes cover earlier ones.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  /// Add a line. `dashes`: as in SVG ("6 3"); empty for a solid line.
  void polyline(const std::vector<Pixel>& points, const std::string& colour, double width = 1.5,
                const std::string& dashes = "");
  void circle(const Pixel& centre, double radius, const std::string& fill);
  void rectangle(const Pixel& corner, double width, double height, const std::string& fill);
  void text(const Pixel& place, const std::string& words, const TextStyle& style = {});

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  /// Complete file. `title`: text for screen readers.
  [[nodiscard]] std::string file(const std::string& title) const;

 private:
  double width_, height_;
  std::string shapes_;
};

}  // namespace plica
