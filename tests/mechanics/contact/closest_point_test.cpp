// The nearest places of two segments, against a search along both. (Of a point and a triangle: contact_truth_test.cpp.)
#include "mechanics/contact/closest_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "support/tissues.hpp"

namespace plica {
namespace {

using support::Random;

using Segment = std::pair<Vec3, Vec3>;

double distance_to(const Vec3& p, const Segment& segment) {
  const Vec3 way = segment.second - segment.first;
  const double squared = way.squaredNorm();
  const double part = squared > 0 ? std::clamp(way.dot(p - segment.first) / squared, 0.0, 1.0) : 0;
  return (p - segment.first - part * way).norm();
}

Vec3 at(const Segment& segment, double part) { return segment.first + part * (segment.second - segment.first); }

// The distance of a place on the first from the second is convex along it.
double distance_by_search(const Segment& first, const Segment& second) {
  double low = 0, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    (distance_to(at(first, a), second) < distance_to(at(first, b), second) ? high : low) =
        distance_to(at(first, a), second) < distance_to(at(first, b), second) ? b : a;
  }
  return distance_to(at(first, (low + high) / 2), second);
}

double distance_of_ends(const Segment& first, const Segment& second) {
  return std::min({distance_to(first.first, second), distance_to(first.second, second),
                   distance_to(second.first, first), distance_to(second.second, first)});
}

TEST(NearestInside, IsTheNearestOrAnEndIs) {
  Random random(3);
  const char* const kinds[] = {"any", "parallel", "on one line", "no length", "two without length", "nearly parallel"};
  for (int kind = 0; kind < 6; ++kind) {
    int inside = 0;
    constexpr int cases = 2000;
    for (int k = 0; k < cases; ++k) {
      Segment first{random.vector(), random.vector()}, second{random.vector(), random.vector()};
      const Vec3 way = first.second - first.first;
      if (kind == 1) second.second = second.first + random.number() * way;
      if (kind == 2) second = {at(first, random.number(2)), at(first, random.number(2))};
      if (kind == 3) second.second = second.first;
      if (kind == 4) first.second = first.first, second.second = second.first;
      if (kind == 5) {  // crossing, at a small angle
        const Vec3 middle = at(first, 0.5) + 0.1 * random.vector(), turned = way + 0.01 * random.vector();
        second = {middle - turned / 2, middle + turned / 2};
      }
      const double truth = distance_by_search(first, second);
      if (const auto places = nearest_inside(first.first, first.second, second.first, second.second)) {
        ++inside;
        EXPECT_GT(places->on_first, 0);
        EXPECT_LT(places->on_first, 1);
        EXPECT_GT(places->on_second, 0);
        EXPECT_LT(places->on_second, 1);
        const Vec3 apart = at(first, places->on_first) - at(second, places->on_second);
        EXPECT_NEAR(apart.norm(), truth, 1e-7) << kinds[kind];
        EXPECT_NEAR(apart.dot(way), 0, 1e-9) << kinds[kind];
        EXPECT_NEAR(apart.dot(second.second - second.first), 0, 1e-9) << kinds[kind];
      } else {
        EXPECT_NEAR(distance_of_ends(first, second), truth, kind == 5 ? 1e-3 : 1e-7) << kinds[kind];
      }
    }
    std::printf("%-18s %d cases, %d inside\n", kinds[kind], cases, inside);
    EXPECT_EQ(inside > 0, kind == 0 || kind == 5) << kinds[kind];
  }
}

}  // namespace
}  // namespace plica
