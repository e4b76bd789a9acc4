// Pictures of frames: what is to be drawn, as plain data, and a painter that makes PNG files of it.
//
// The painter is VTK, off screen. Debian's VTK draws through X, and VTK ends the process when that fails: so a child
// process draws, and where no display answers an own X server without a screen is started (display.hpp).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mechanics/obstacles/vitelline.hpp"
#include "show/looks.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// A moment, or a run: what stands below each other in a picture.
struct PictureColumn {
  std::string heading;  // "5 min"
  Frame frame;
  Vectors dots = {};  // places that are marked, um
};

/// A view: what stands beside each other.
struct PictureRow {
  View view;
  std::array<double, 2> half_size_um = {0, 0};  // how far the panel reaches from the origin, to the sides and upwards
};

/// A grid of panels at one scale, with a legend, a scale bar, and a heading for each column and row.
struct Picture {
  std::vector<PictureColumn> columns;
  std::vector<PictureRow> rows;
  ColourField field;
  ColourRange range;
  std::vector<std::string> step_names = {};  // of a field of steps: what its numbers stand for, from 0
  std::optional<Frame> rest = {};            // its outline is drawn in sections, in grey, unless the shell is
  std::optional<Capsule> shell = {};         // drawn around the embryo
  bool edges = true;                         // outlines of cells
  bool anatomy = true;                       // A, P, D, V, L, R at the ends of the embryo in the first column
  int width_px = 0, height_px = 0;           // 0: as wide as the number of columns asks for; as high as the content
};

inline constexpr int smallest_picture_px = 200, largest_picture_px = 6000;  // of a side

/// How far positions reach from the origin as a view shows them, to the sides and upwards, um.
std::array<double, 2> half_size_um(const Vectors& positions, const View& view);

/// Draws pictures; keeps the screen that they are drawn on from one to the next.
class Painter {
 public:
  /// FileError when there is no screen and none can be started, or plica was built without VTK.
  Painter();
  ~Painter();

  /// The bytes of a PNG file; of the same picture the same bytes. FileError when VTK could not draw it, or a
  /// frame lacks what is to be shown; UsageError when the size asked for is too small.
  std::string png(const Picture& picture);

 private:
  struct Screen;
  std::unique_ptr<Screen> screen_;
};

}  // namespace plica
