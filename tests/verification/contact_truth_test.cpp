// Contact's distances and the crossing test against another program's, the IPC Toolkit's: what
// contact_truth/make_truth.py wrote, some hundred cases of either, or 10 000 in a folder that PLICA_CONTACT_TRUTH
// names.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>
#include <sstream>

#include "measure/self_intersections.hpp"
#include "mechanics/contact/closest_point.hpp"

namespace plica {
namespace {

struct Case {
  std::string kind;
  std::vector<double> numbers;

  [[nodiscard]] Vec3 vector(std::size_t k) const { return {numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]}; }
};

std::vector<Case> cases_of(const std::string& name) {
  const char* given = std::getenv("PLICA_CONTACT_TRUTH");
  std::ifstream file((given ? std::string(given) : PLICA_SOURCE_DIR "/tests/verification/contact_truth") + "/" + name);
  std::vector<Case> cases;
  for (std::string line; std::getline(file, line);) {
    std::stringstream fields(line);
    Case one;
    std::getline(fields, one.kind, ',');
    for (std::string number; std::getline(fields, number, ',');) one.numbers.push_back(std::stod(number));
    cases.push_back(std::move(one));
  }
  return cases;
}

TEST(ContactTruth, DistancesAndTheirGradients) {
  const std::vector<Case> cases = cases_of("point_triangle.csv");
  ASSERT_GE(cases.size(), 200u);
  struct Worst {
    double distance = 0, gradient = 0;
  };
  std::map<std::string, Worst> worst;  // over the size of the case
  for (const Case& one : cases) {
    const Vec3 p = one.vector(0), a = one.vector(1), b = one.vector(2), c = one.vector(3);
    const auto [weights, squared_distance] = closest_on_triangle(p, a, b, c);
    const double size = std::max({(p - a).norm(), (p - b).norm(), (p - c).norm(), (a - b).norm(), (a - c).norm()});
    for (const double weight : weights) {
      EXPECT_GE(weight, -1e-12) << one.kind;
      EXPECT_LE(weight, 1 + 1e-12) << one.kind;
    }
    EXPECT_NEAR(weights[0] + weights[1] + weights[2], 1, 1e-12) << one.kind;
    if (size == 0) continue;
    Worst& here = worst[one.kind];
    here.distance = std::max(here.distance, std::abs(std::sqrt(squared_distance) - std::sqrt(one.numbers[12])) / size);
    // Of the squared distance: 2 (p - q) by the point, and -2 w (p - q) by a corner of weight w.
    const std::span<const double> gradient = std::span(one.numbers).subspan(13);
    const Vec3 from_triangle = p - weights[0] * a - weights[1] * b - weights[2] * c;
    const bool has_area = (b - a).cross(c - a).norm() > 0;
    for (int k = 0; k < (has_area ? 4 : 1); ++k) {
      const Vec3 ours = (k == 0 ? 2 : -2 * weights[k - 1]) * from_triangle;
      const Vec3 theirs(gradient[3 * k], gradient[3 * k + 1], gradient[3 * k + 2]);
      here.gradient = std::max(here.gradient, (ours - theirs).norm() / size);
    }
  }
  for (const auto& [kind, of_kind] : worst) {
    std::printf("%-15s distance %.1e, gradient %.1e of the size\n", kind.c_str(), of_kind.distance, of_kind.gradient);
    EXPECT_LE(of_kind.distance, 1e-9) << kind;
    EXPECT_LE(of_kind.gradient, 1e-9) << kind;
  }
  RecordProperty("cases", static_cast<int>(cases.size()));
}

TEST(ContactTruth, Crossings) {
  const std::vector<Case> cases = cases_of("facets.csv");
  ASSERT_GE(cases.size(), 200u);
  int crossing = 0, touching = 0, apart = 0;
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const Case& one = cases[n];
    std::array<Facet, 2> facets;
    Vectors positions;
    for (std::size_t k = 0; k < 8; ++k) {
      facets[k / 4].nodes[k % 4] = NodeId(k);
      positions.push_back(one.vector(k));
    }
    const bool cross = one.numbers[24] != 0, touch = one.numbers[25] != 0;
    ++(cross ? crossing : touch ? touching : apart);
    EXPECT_EQ(crossing_facets(facets, positions).size(), cross ? 1u : 0u) << one.kind << ", line " << n + 1;
  }
  std::printf("%d pairs cross, %d touch, %d are apart\n", crossing, touching, apart);
  EXPECT_GT(std::min({crossing, touching, apart}), 10);
}

}  // namespace
}  // namespace plica
