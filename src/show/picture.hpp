// Pictures of snapshots: description as plain data, and a painter that makes PNG files of it.
//
// The painter uses VTK off screen. Debian's VTK draws through X and ends the process if that fails, so a child process
// draws, and without a working display a virtual X server is started.
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

/// Column of a picture: one time, or one run.
struct PictureColumn {
  std::string heading;  // "5 min"
  Frame frame;
};

/// Row of a picture: one view.
struct PictureRow {
  View view;
  std::array<double, 2> half_size_um = {0, 0};  // half width and half height of the panel
};

/// Picture: grid of panels at one scale, with legend, scale bar and headings of columns and rows.
struct Picture {
  std::vector<PictureColumn> columns;
  std::vector<PictureRow> rows;
  ColourField field;
  ColourRange range;
  std::vector<std::string> step_names = {};            // names of the integers of a field of steps, from 0
  std::optional<Frame> rest = {};                      // grey reference outline in sections, unless the shell is drawn
  std::optional<Capsule> shell = {};                   // drawn around the embryo
  bool edges = true;                                   // outlines of cells
  EmbryoAxes letters = letters_of(anatomical_axes());  // at the ends of the tissue, in the first column; may be empty
  int width_px = 0, height_px = 0;                     // 0: width by the number of columns; height by the content
};

inline constexpr int smallest_picture_px = 200, largest_picture_px = 6000;  // of a side

/// Half width and half height of positions in a view, about the origin, um.
std::array<double, 2> half_size_um(const Vectors& positions, const View& view);

/// Painter of pictures; keeps its screen between them.
class Painter {
 public:
  /// Throws FileError without a screen, or in builds without VTK.
  Painter();
  ~Painter();

  /// Draw a picture; returns the bytes of a PNG file, equal for equal pictures. Throws FileError if VTK fails or a
  /// snapshot lacks the field, UsageError for too small a size.
  std::string png(const Picture& picture);

 private:
  struct Screen;
  std::unique_ptr<Screen> screen_;
};

}  // namespace plica
