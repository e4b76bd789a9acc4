// Where things stand in a picture, and what a panel shows; nothing of it needs VTK.
#include "show/picture_layout.hpp"

#include "core/errors.hpp"
#include "support/frames.hpp"
#include "support/looks.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

Picture picture_of(const Frame& frame, const std::vector<std::string>& rows, int columns) {
  Picture picture;
  for (int i = 0; i < columns; ++i) picture.columns.push_back({std::to_string(i) + " min", frame});
  for (const std::string& name : rows) picture.rows.push_back({view(name), half_size_um(frame.positions, view(name))});
  picture.field = field("displacement");
  picture.range = {0, 30};
  return picture;
}

Frame pill() { return frame_of(build_shell({460, 280, 40, {6, 3, 3}, {1, 1, 1}})); }

std::vector<std::string> texts_of(const Layout& layout) {
  std::vector<std::string> texts;
  for (const Label& label : layout.labels) texts.push_back(label.text);
  return texts;
}

bool contains(const std::vector<std::string>& texts, const std::string& text) {
  return std::ranges::find(texts, text) != texts.end();
}

TEST(PictureLayout, PanelsFillTheirGridWithoutTouchingAndHoldTheEmbryo) {
  for (const auto& rows : {std::vector<std::string>{"ventral"},
                           {"antero-ventral", "cross-section"},
                           {"ventral", "side", "cross-section", "sagittal-section"}})
    for (const int columns : {1, 2, 5})
      for (const auto [width, height] : {std::array{0, 0}, {1400, 900}, {3000, 2000}}) {
        Picture picture = picture_of(pill(), rows, columns);
        picture.width_px = width, picture.height_px = height;
        const Layout layout = make_layout(picture);
        if (width > 0) {
          EXPECT_EQ((std::array{layout.width_px, layout.height_px}), (std::array{width, height}));
        }
        EXPECT_EQ(layout.panels.size(), rows.size() * static_cast<std::size_t>(columns));
        EXPECT_EQ(layout.height_px % 2, 0);
        for (const Panel& panel : layout.panels) {
          const auto& half = picture.rows[panel.row].half_size_um;
          EXPECT_GE(panel.box.width, 2 * half[0] / layout.um_per_px);
          EXPECT_GE(panel.box.height, 2 * half[1] / layout.um_per_px - 1e-6);
          EXPECT_GE(panel.box.left, 0);
          EXPECT_GE(panel.box.bottom, 0);
          EXPECT_LE(panel.box.left + panel.box.width, layout.width_px);
          EXPECT_LE(panel.box.bottom + panel.box.height, layout.height_px);
          for (const Panel& other : layout.panels) {
            if (&other == &panel) continue;
            const bool apart_across = panel.box.left + panel.box.width <= other.box.left + 1e-6 ||
                                      other.box.left + other.box.width <= panel.box.left + 1e-6;
            const bool apart_upwards = panel.box.bottom + panel.box.height <= other.box.bottom + 1e-6 ||
                                       other.box.bottom + other.box.height <= panel.box.bottom + 1e-6;
            EXPECT_TRUE(apart_across || apart_upwards);
          }
        }
        for (const Label& label : layout.labels) {
          EXPECT_TRUE(label.x >= 0 && label.x <= layout.width_px && label.y >= 0 && label.y <= layout.height_px)
              << label.text;
          EXPECT_GE(label.size_px / layout.width_px * 160, 7 * 25.4 / 72) << label.text;  // 7 points at 16 cm
        }
      }
}

TEST(PictureLayout, SaysWhatIsShown) {
  const Layout layout = make_layout(picture_of(pill(), {"ventral", "cross-section"}, 2));
  const std::vector<std::string> texts = texts_of(layout);
  for (const char* text :
       {"0 min", "1 min", "ventral", "cross-section", "displacement,", "µm", "0", "30", "100 µm", "A", "P", "D", "V"})
    EXPECT_TRUE(contains(texts, text)) << text;
  EXPECT_EQ(std::ranges::count(texts, "L"), 2);  // at the upper end from below, at the right one from the front
  Picture plain = picture_of(pill(), {"ventral"}, 1);
  plain.letters = {};
  EXPECT_FALSE(contains(texts_of(make_layout(plain)), "A"));
  plain.field = field("pressure");
  plain.range = {-200, 200};
  EXPECT_TRUE(contains(texts_of(make_layout(plain)), "\u2212100"));
  plain.range = {0, 20000};
  EXPECT_TRUE(contains(texts_of(make_layout(plain)), "15000"));
}

TEST(PictureLayout, MarksStandAtTheirEndsOfTheEmbryo) {
  const auto place = [&](const std::string& view_name, const std::string& mark) -> std::array<double, 2> {
    const Layout layout = make_layout(picture_of(pill(), {view_name}, 1));
    const auto label = std::ranges::find(layout.labels, mark, &Label::text);
    if (label == layout.labels.end()) return {0, 0};
    const Box& box = layout.panels.front().box;
    return {(label->x - box.left - box.width / 2) * layout.um_per_px,
            (label->y - box.bottom - box.height / 2) * layout.um_per_px};
  };
  EXPECT_LT(place("ventral", "A")[0], -215);
  EXPECT_GT(place("ventral", "P")[0], 215);
  EXPECT_GT(place("ventral", "L")[1], 130);
  EXPECT_EQ(place("ventral", "V"), (std::array<double, 2>{0, 0}));  // towards the eye
  EXPECT_GT(place("side", "D")[1], 130);
  EXPECT_LT(place("cross-section", "R")[0], -130);
  EXPECT_LT(place("cross-section", "V")[1], -130);
}

TEST(PictureLayout, RefusesWhatHoldsNothing) {
  Picture picture = picture_of(pill(), {"ventral", "side", "cross-section"}, 5);
  picture.width_px = picture.height_px = 200;
  EXPECT_THROW(make_layout(picture), UsageError);
}

TEST(ScaleTicks, AreRoundAndWithinTheRange) {
  EXPECT_EQ(scale_ticks({0, 35}, 8), (std::vector<double>{0, 5, 10, 15, 20, 25, 30, 35}));
  EXPECT_EQ(scale_ticks({0, 35}, 5), (std::vector<double>{0, 10, 20, 30}));
  EXPECT_EQ(scale_ticks({-250, 250}, 5), (std::vector<double>{-200, -100, 0, 100, 200}));
  EXPECT_EQ(scale_ticks({3, 3}, 5), (std::vector<double>{3}));
  for (const double low : {0.0, -1.0, 0.7, -2e-10, 1e6})
    for (const double span : {1e-9, 0.013, 1.0, 7.7, 123456.0})
      for (const int most : {2, 5, 8}) {
        if (low + span / 100 == low) continue;  // finer than numbers are
        const std::vector<double> ticks = scale_ticks({low, low + span}, most);
        EXPECT_GE(ticks.size(), 2u);
        EXPECT_LE(ticks.size(), static_cast<std::size_t>(most));
        EXPECT_GE(ticks.front(), low - 1e-6 * span);
        EXPECT_LE(ticks.back(), low + span * (1 + 1e-6));
      }
}

TEST(RoundLength, IsOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_length(100), 100);
  EXPECT_DOUBLE_EQ(round_length(99), 50);
  EXPECT_DOUBLE_EQ(round_length(0.03), 0.02);
}

TEST(Wrapped, BreaksBetweenWords) {
  EXPECT_EQ(wrapped("displacement from rest, µm", 13), (std::vector<std::string>{"displacement", "from rest, µm"}));
  EXPECT_EQ(wrapped("incompressibility", 5), (std::vector<std::string>{"incompressibility"}));
  EXPECT_EQ(wrapped("", 5), (std::vector<std::string>{""}));
}

TEST(Scene, IsTheOuterSurfaceOrTheSectionAlone) {
  const Picture picture = picture_of(pill(), {"ventral", "cross-section"}, 1);
  const Scene outside = make_scene(picture, picture.columns[0], picture.rows[0].view, 3);
  // 2(6*3 + 3*3 + 3*6) = 90 cells with an apical and a basal facet each, of four triangles.
  EXPECT_EQ(outside.corners.size(), 2u * 90 * 4 * 3);
  EXPECT_TRUE(outside.lit);
  const Scene section = make_scene(picture, picture.columns[0], picture.rows[1].view, 3);
  EXPECT_FALSE(section.lit);
  for (const Vec3& corner : section.corners) EXPECT_NEAR(corner.x(), view_cut_um, 1e-9);
  EXPECT_EQ(section.outlines.size(), 12u * 3);  // of 12 cells around: a wall to the next, an outer and an inner side
}

TEST(Scene, OutlinesOfASectionPartCellsAndNotTheElementsOfOne) {
  const Frame fine = frame_of(build_shell({460, 280, 40, {6, 3, 3}, {2, 2, 2}}));
  const Picture picture = picture_of(fine, {"cross-section"}, 1);
  const Scene section = make_scene(picture, picture.columns[0], picture.rows[0].view, 3);
  // Walls of two pieces, outer and inner sides of two pieces each.
  EXPECT_EQ(section.outlines.size(), 12u * (2 + 2 + 2));
}

// On the pill's cap, a quarter of its length from its end.
TEST(Scene, OfASectionElsewhereIsCutThere) {
  Picture picture = picture_of(pill(), {"cross-section"}, 1);
  picture.rest = pill();
  picture.rows[0].view = cross_section_at(150);
  const Scene section = make_scene(picture, picture.columns[0], picture.rows[0].view, 3);
  EXPECT_FALSE(section.corners.empty());
  for (const Vec3& corner : section.corners) EXPECT_NEAR(corner.x(), 150, 0.02);
  ASSERT_FALSE(section.rest.empty());
  for (const auto& [from, to] : section.rest) EXPECT_NEAR(from.x(), 150, 0.02);
}

// A box for each step that is there, its name beside it, all within the picture.
TEST(PictureLayout, StepsAreNamedAndFit) {
  for (const auto [width, height] : {std::array{0, 0}, {1600, 900}, {1100, 300}})
    for (const int columns : {1, 3}) {
      Picture picture = picture_of(pill(), {"ventral"}, columns);
      picture.field = field("region");
      picture.range = {0, 5};
      picture.step_names = {"other cells", "mesoderm", "a-rather-long-name", "furrow"};
      picture.width_px = width, picture.height_px = height;
      const Layout layout = make_layout(picture);
      const std::vector<std::string> texts = texts_of(layout);
      EXPECT_TRUE(contains(texts, "region"));
      EXPECT_FALSE(contains(texts, "4")) << "a number that nobody has";
      for (const std::string& name : picture.step_names) {
        const auto label = std::ranges::find(layout.labels, name, &Label::text);
        ASSERT_NE(label, layout.labels.end()) << name;
        EXPECT_LE(label->x + 0.56 * static_cast<double>(name.size()) * label->size_px, layout.width_px) << name;
        EXPECT_GE(label->y, 0);
        EXPECT_LE(label->y, layout.height_px);
      }
      for (const Rectangle& rectangle : layout.rectangles) {
        EXPECT_GE(rectangle.box.bottom, 0);
        EXPECT_LE(rectangle.box.bottom + rectangle.box.height, layout.height_px);
      }
    }
}

TEST(Scene, HasTheRestOutlineOrTheShell) {
  Picture picture = picture_of(pill(), {"cross-section"}, 1);
  const auto scene = [&] { return make_scene(picture, picture.columns[0], picture.rows[0].view, 3); };
  EXPECT_TRUE(scene().rest.empty());
  picture.rest = pill();
  EXPECT_EQ(scene().rest.size(), 12u);
  picture.shell = Capsule{90, 140};
  EXPECT_TRUE(scene().rest.empty());
  for (const Vec3& corner : scene().shell) {
    const double radius = std::hypot(corner.y(), corner.z());
    EXPECT_TRUE(std::abs(radius - 140) < 1e-9 || std::abs(radius - 143) < 1e-9) << radius;
  }
  picture.rows[0].view = view("side");
  double farthest = 0;
  for (const Vec3& corner : scene().shell) farthest = std::max(farthest, std::abs(corner.x()));
  EXPECT_NEAR(farthest, 90 + 143, 1e-3);
  picture.edges = false;
  EXPECT_TRUE(scene().outlines.empty());
}

}  // namespace
