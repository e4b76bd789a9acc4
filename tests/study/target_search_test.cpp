#include "study/target_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <limits>

namespace plica {
namespace {

using Place = std::vector<double>;

struct Searched {
  int looks = 0;
  double best = std::numeric_limits<double>::infinity();
  Place where;
};

// Searches with a function for the runs, for at most 100 looks.
Searched search(const Place& start, std::size_t targets, const std::function<std::vector<double>(const Place&)>& run) {
  Searched searched;
  search_targets(start, targets, [&](const Place& place) {
    const std::vector<double> misses = run(place);
    for (const double x : place) EXPECT_TRUE(x >= 0 && x <= 1) << x;
    ++searched.looks;
    if (worst_miss(misses) < searched.best) searched.best = worst_miss(misses), searched.where = place;
    return Look{misses, worst_miss(misses) <= 1 || searched.looks >= 100};
  });
  return searched;
}

TEST(TargetSearch, OneKeyOneTargetIsBracketed) {
  const Searched found = search({0.9}, 1, [](const Place& x) { return Place{(std::exp(x[0]) - 1.5) * 1000}; });
  EXPECT_LE(found.best, 1);
  EXPECT_NEAR(found.where[0], std::log(1.5), 1e-3);
  EXPECT_LE(found.looks, 6);
}

TEST(TargetSearch, EndsThatDoNotBracketMayHideAMeetingPlace) {
  const Searched found = search({0.5}, 1, [](const Place& x) { return Place{300 * (0.02 - std::pow(x[0] - 0.6, 2))}; });
  EXPECT_LE(found.best, 1);
  EXPECT_LE(found.looks, 20);
}

TEST(TargetSearch, FindsTheNearestWhereNothingMeets) {
  const Searched inside = search({0.5}, 1, [](const Place& x) { return Place{100 + 100 * std::pow(x[0] - 0.6, 2)}; });
  EXPECT_NEAR(inside.where[0], 0.6, 0.05);
  const Searched at_bound = search({0.5}, 1, [](const Place& x) { return Place{100 + 100 * x[0]}; });
  EXPECT_EQ(at_bound.where, Place{0});
  EXPECT_LE(std::max(inside.looks, at_bound.looks), 25) << "it ends when it gets nowhere";
}

TEST(TargetSearch, SeveralKeysAndTargets) {
  const Searched two = search({0.5, 0.5}, 2, [](const Place& x) {
    return Place{7 * (28 * x[0] * std::sqrt(0.3 + x[1]) - 14), 30 * ((1 + x[1]) / (0.2 + x[0]) - 3)};
  });
  const Searched three = search({0.5, 0.5, 0.5}, 3, [](const Place& x) {
    return Place{200 * (std::exp(x[0]) * x[1] - 0.5), 200 * (x[0] + x[1] * x[2] - 0.6),
                 200 * (x[2] * x[2] - x[0] - 0.2)};
  });
  std::cout << two.looks << " looks with two keys, " << three.looks << " with three\n";
  EXPECT_LE(two.best, 1);
  EXPECT_LE(two.looks, 12);
  EXPECT_LE(three.best, 1);
  EXPECT_LE(three.looks, 20);
}

TEST(TargetSearch, MoreTargetsThanKeysAndFewer) {
  const Searched more = search({0.9}, 2, [](const Place& x) { return Place{100 * (x[0] - 0.4), 100 * (x[0] - 0.6)}; });
  EXPECT_NEAR(more.where[0], 0.5, 0.01) << "the largest miss is least in the middle";
  EXPECT_NEAR(more.best, 10, 1);
  const Searched fewer = search({0.5, 0.5}, 1, [](const Place& x) { return Place{200 * (x[0] * x[1] - 0.8)}; });
  EXPECT_LE(fewer.best, 1);
}

TEST(TargetSearch, GoesOnWhereThereIsNoValue) {
  const auto hole = [](double low, double high) {
    return [=](const Place& x) { return x[0] > low && x[0] < high ? Place{} : Place{100 * (x[0] - 0.3)}; };
  };
  int cases = 0;
  // At an end, inside the bracket, at the start of the search without a bracket.
  for (const auto& run : {hole(0.9, 2), hole(-1, 0.05), hole(0.35, 0.7)}) {
    EXPECT_LE(search({0.5}, 1, run).best, 1) << cases;
    ++cases;
  }
  std::cout << cases << " cases\n";
  const Searched none = search({0.5, 0.5}, 2, [](const Place&) { return Place{}; });
  EXPECT_TRUE(std::isinf(none.best));
  EXPECT_LE(none.looks, 25);
}

}  // namespace
}  // namespace plica
