// Vector pictures: the few shapes that plots need, written as SVG that any browser shows.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace plica {

/// A place in a picture: pixels from its left and upper edge.
using Pixel = std::array<double, 2>;

/// How text stands at its place.
struct TextStyle {
  double size = 12;
  std::string anchor = "start";  // start | middle | end
  bool bold = false;
  bool upwards = false;  // turned by a quarter, to read from below
};

/// A picture on white that grows shape by shape; later ones cover earlier ones.
class Svg {
 public:
  Svg(double width, double height) : width_(width), height_(height) {}

  /// `dashes` as SVG has them ("6 3"); empty for a whole line.
  void polyline(const std::vector<Pixel>& points, const std::string& colour, double width = 1.5,
                const std::string& dashes = "");
  void circle(const Pixel& centre, double radius, const std::string& fill);
  void rectangle(const Pixel& corner, double width, double height, const std::string& fill);
  void text(const Pixel& place, const std::string& words, const TextStyle& style = {});

  [[nodiscard]] double width() const { return width_; }
  [[nodiscard]] double height() const { return height_; }
  /// The whole file. `title` is read out by screen readers.
  [[nodiscard]] std::string file(const std::string& title) const;

 private:
  double width_, height_;
  std::string shapes_;
};

}  // namespace plica
