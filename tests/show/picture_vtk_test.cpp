// Pictures as files: drawn, read back, and looked at pixel by pixel.
#include <gtest/gtest.h>
#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/errors.hpp"
#include "show/boundary_surface.hpp"
#include "show/picture_layout.hpp"
#include "support/frames.hpp"
#include "support/tissues.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

const ColourField& field(const std::string& name) {
  return *std::ranges::find(colour_fields(), name, &ColourField::name);
}
const View& view(const std::string& name) { return *std::ranges::find(views(), name, &View::name); }

struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;  // lower row first

  [[nodiscard]] std::array<int, 3> at(double x, double y) const {
    const std::size_t place =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[place], rgb[place + 1], rgb[place + 2]};
  }
};

Image read_png(const std::string& bytes) {
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(bytes.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(bytes.size()));
  reader->Update();
  vtkImageData& data = *reader->GetOutput();
  Image image{data.GetDimensions()[0], data.GetDimensions()[1], {}};
  EXPECT_EQ(data.GetNumberOfScalarComponents(), 3);
  const auto* first = static_cast<const unsigned char*>(data.GetScalarPointer());
  image.rgb.assign(first, first + std::size_t{3} * image.width * image.height);
  return image;
}

int distance(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

int distance(const std::array<int, 3>& a, const Rgb& colour) {
  return distance(
      a, std::array{static_cast<int>(std::lround(255 * colour[0])), static_cast<int>(std::lround(255 * colour[1])),
                    static_cast<int>(std::lround(255 * colour[2]))});
}

/// The pill, its belly drawn in; cells have pressures of their own.
Picture pill_picture(const std::vector<std::string>& rows, const std::string& colour) {
  const Tissue tissue = build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}});
  Vectors displacements;
  for (const Vec3& place : tissue.rest_positions)
    displacements.emplace_back(0, 0, place.z() < 0 ? 30 * std::pow(place.z() / 140, 2) : 0);
  Frame frame = support::frame_of(tissue, displacements);
  for (std::size_t n = 0; n < frame.positions.size(); ++n) frame.positions[n] += displacements[n];
  for (std::size_t e = 0; e < frame.elements.size(); ++e)
    frame.element_scalars["pressure_Pa"].push_back(200 * std::sin(static_cast<double>(37 * e)));
  Picture picture;
  picture.columns.push_back({"5 min", frame});
  for (const std::string& name : rows)
    picture.rows.push_back({view(name), half_size_um(tissue.rest_positions, view(name))});
  picture.field = field(colour);
  picture.range = colour == "pressure" ? ColourRange{-200, 200} : ColourRange{0, 30};
  picture.width_px = 500;
  return picture;
}

/// Where a place of the embryo is, in pixels.
std::array<double, 2> pixel_of(const Layout& layout, const Panel& panel, const View& seen, const Vec3& place) {
  const auto [right, up] = screenwise(seen);
  return {panel.box.left + panel.box.width / 2 + place.dot(right) / layout.um_per_px,
          panel.box.bottom + panel.box.height / 2 + place.dot(up) / layout.um_per_px};
}

TEST(Picture, HasTheSizeAskedForAndIsTheSameTwice) {
  Picture picture = pill_picture({"antero-ventral", "cross-section"}, "displacement");
  picture.width_px = 640, picture.height_px = 481;
  Painter painter;
  const std::string bytes = painter.png(picture);
  const Image image = read_png(bytes);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 481);
  EXPECT_EQ(image.at(1, 1), (std::array{255, 255, 255}));
  EXPECT_EQ(painter.png(picture), bytes);
}

TEST(Picture, ColoursOfASectionAreThoseOfTheLegend) {
  int cases = 0;
  for (const char* colour : {"pressure", "displacement"}) {
    const Picture picture = pill_picture({"cross-section"}, colour);
    const Layout layout = make_layout(picture);
    const Image image = read_png(Painter().png(picture));
    const Frame& frame = picture.columns[0].frame;
    const std::vector<double> values = field_values(frame, picture.field);
    for (const CutPolygon& polygon : cut_by_plane(frame, 0, view_cut_um)) {
      Vec3 middle = Vec3::Zero();
      double value = 0;
      for (const auto& corner : polygon.corners) {
        const auto count = static_cast<double>(polygon.corners.size());
        middle += corner.of(frame.positions) / count;
        value += (picture.field.on_nodes ? corner.of(values) : values[polygon.element]) / count;
      }
      const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, middle);
      EXPECT_LE(distance(image.at(x, y), colour_of(picture.field.map(), picture.range, value)), 4)
          << colour << " " << value << " at " << x << " " << y;
      ++cases;
    }
  }
  std::cout << cases << " cells\n";
  EXPECT_GT(cases, 20);
}

TEST(Picture, OfASymmetricEmbryoIsSymmetric) {
  Picture picture = pill_picture({"ventral"}, "displacement");
  picture.letters = {};
  const Box box = make_layout(picture).panels[0].box;
  const Image image = read_png(Painter().png(picture));
  const double middle_x = box.left + box.width / 2, middle_y = box.bottom + box.height / 2;
  int differ_upwards = 0, differ_across = 0, coloured = 0;
  for (double y = 0.5; y < std::floor(box.height / 2); ++y)
    for (double x = 0.5; x < std::floor(box.width / 2); ++x) {
      const auto here = image.at(middle_x - x, middle_y - y);
      coloured += here != std::array{255, 255, 255};
      differ_upwards += distance(here, image.at(middle_x - x, middle_y + y)) > 40;
      differ_across += distance(here, image.at(middle_x + x, middle_y - y)) > 40;
    }
  EXPECT_GT(coloured, 5000);
  // The smoothing of lines is not symmetric to the last pixel.
  EXPECT_LT(differ_upwards, coloured / 100);
  EXPECT_LT(differ_across, coloured / 100);
}

// A sheet of 20 um whose lower side has walls that its upper side has not: nothing of them is seen from above.
TEST(Picture, OfASmallSheetShowsNoEdgeBehindItsSurface) {
  Tissue sheet =
      support::mapped_lattice(4, 4, 1, [](int i, int j, int k) { return Vec3(5 * i - 10, 5 * j - 10, 0.5 * k); });
  Picture picture;
  picture.columns.push_back({"", support::frame_of(sheet)});
  const View seen = {"tilted", "", {0.4, 0.3, -0.87}, {0, 1, 0}, {}};
  picture.rows.push_back({seen, half_size_um(sheet.rest_positions, seen)});
  picture.field = field("displacement");
  picture.width_px = 800;
  const Layout layout = make_layout(picture);
  const Image image = read_png(Painter().png(picture));
  int cases = 0;
  // The edges of the lower side, 0.5 um below the upper one, are seen through its cells' middles where they are drawn
  // in front of it.
  for (const auto& place : sheet.rest_positions) {
    if (place.z() > 0 || place.x() > 9 || place.y() < -9) continue;  // that of the near side is seen
    const Vec3 on_edge = place + Vec3(2.5, 0, 0);
    const auto [x, y] = pixel_of(layout, layout.panels[0], seen, on_edge);
    ++cases;
    EXPECT_GT(image.at(x, y)[0], 150) << x << " " << y;
  }
  EXPECT_EQ(cases, 16);
}

TEST(Picture, HasALegendInTheColoursOfItsMap) {
  const Picture picture = pill_picture({"ventral"}, "displacement");
  const Layout layout = make_layout(picture);
  const Image image = read_png(Painter().png(picture));
  const ColourMap& map = picture.field.map();
  int found = 0;
  for (const Rectangle& rectangle : layout.rectangles) {
    const Box& box = rectangle.box;
    if (box.height > 1.01 || rectangle.colour[0] == rectangle.colour[2]) continue;  // lines
    found += distance(image.at(box.left + box.width / 2, box.bottom + box.height / 2), rectangle.colour) < 12;
  }
  EXPECT_GT(found, 60);
  // A label is darker than paper somewhere.
  for (const Label& label : layout.labels) {
    int darkest = 255;
    for (double dy = -4; dy <= 4; ++dy)
      for (double dx = -8; dx <= 8; ++dx) {
        const double x = label.x + dx + (label.is_centred ? 0 : 8);
        darkest = std::min(darkest, image.at(std::min(x, image.width - 1.0), label.y + dy)[1]);
      }
    EXPECT_LT(darkest, 140) << label.text;
  }
  EXPECT_EQ(map.name, "still");
}

TEST(Picture, OfAnotherRangeHasOtherColours) {
  Picture picture = pill_picture({"cross-section"}, "displacement");
  Painter painter;
  const Layout layout = make_layout(picture);
  const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, {0, 0, -140 + 30 + 15});
  const auto dark = read_png(painter.png(picture)).at(x, y);
  picture.range.high = 300;
  const auto light = read_png(painter.png(picture)).at(x, y);
  EXPECT_GT(light[0], dark[0] + 60);
}

TEST(Picture, ShowsTheShellWhereTheEmbryoHasLeftIt) {
  Picture picture = pill_picture({"cross-section"}, "displacement");
  Painter painter;
  picture.shell = Capsule{90, 140};
  const Layout layout = make_layout(picture);
  const double half_band_um = 0.15 * layout.font_px * layout.um_per_px / 2;
  const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, {0, 0, -140 - half_band_um});
  EXPECT_LT(read_png(painter.png(picture)).at(x, y)[0], 220);
  picture.shell.reset();
  EXPECT_EQ(read_png(painter.png(picture)).at(x, y)[0], 255);
}

}  // namespace
}  // namespace plica
