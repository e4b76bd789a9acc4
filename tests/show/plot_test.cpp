#include "show/plot.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace plica {
namespace {

TEST(AxisTicks, AreRoundAndInside) {
  EXPECT_EQ(axis_ticks(0, 10, false), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  const std::vector<double> decades = axis_ticks(0.05, 1200, true);
  EXPECT_EQ(decades.size(), 5u);  // 0.1 to 1000
  EXPECT_NEAR(decades.front(), 0.1, 1e-12);
  int cases = 0;
  for (const double low : {-3.0, 0.0, 0.7})
    for (const double width : {1e-3, 1.0, 37.0, 5e4}) {
      const std::vector<double> ticks = axis_ticks(low, low + width, false);
      ASSERT_GE(ticks.size(), 3u) << low << " " << width;
      EXPECT_LE(ticks.size(), 9u) << low << " " << width;
      EXPECT_GE(ticks.front(), low - 1e-9 * width);
      EXPECT_LE(ticks.back(), low + width * (1 + 1e-9));
      ++cases;
    }
  EXPECT_EQ(cases, 12);
}

TEST(Plot, LeavesOutWhatHasNoPlace) {
  const Plot plot{"a < b", {"time, s", true}, {"speed"}, {{"curve", {0, 1, 2, 3}, {1, NAN, 2, 3}, true}}, {}, {}};
  const std::string svg = draw(plot).file(plot.title);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
  // Time 0 has no place on a logarithmic axis and the second value none at all: two points are left.
  std::size_t dots = 0;
  for (std::size_t at = svg.find("r=\"3.5\""); at != std::string::npos; at = svg.find("r=\"3.5\"", at + 1)) ++dots;
  EXPECT_EQ(dots, 2u + 1u);  // and the legend's
  EXPECT_EQ(plot_csv(plot), "curve,\"time, s\",speed\ncurve,0,1\ncurve,1,\ncurve,2,2\ncurve,3,3\n");
}

}  // namespace
}  // namespace plica
