#include "solver/multigrid/order.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/threads.hpp"
#include "solver/multigrid/smoother.hpp"
#include "support/cubes.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

BlockPattern box(int nx, int ny, int nz, const std::vector<int>& names) {
  std::vector<int> groups = support::cubes_of_box(nx, ny, nz);
  for (int& node : groups) node = names[node];
  return pattern_of_groups(nx * ny * nz, groups, 8);
}

std::vector<int> shuffled(int count) {
  std::vector<int> names(count);
  std::iota(names.begin(), names.end(), 0);
  support::Random random(3);
  for (int i = count; i-- > 1;) std::swap(names[i], names[static_cast<int>(0.5 * (random.number() + 1) * i)]);
  return names;
}

void expect_bounds(const Rows& rows, const std::vector<int>& bounds) {
  ASSERT_EQ(bounds.front(), 0);
  ASSERT_EQ(bounds.back(), rows.count());
  const auto group_of = [&](int row) { return std::ranges::upper_bound(bounds, row) - bounds.begin() - 1; };
  for (int row = 0; row < rows.count(); ++row)
    for (const int column : rows.of(row)) EXPECT_LE(std::abs(group_of(row) - group_of(column)), 1);
}

TEST(MultigridOrder, NeighboursAreInGroupsBesideEachOtherHoweverNodesAreNumbered) {
  for (const bool shuffle : {false, true}) {
    std::vector<int> names = shuffled(60 * 8 * 3);
    if (!shuffle) std::ranges::sort(names);
    const BlockPattern pattern = box(60, 8, 3, names);
    const std::vector<int> places = multigrid::places_by_distance(pattern);
    std::vector<int> sorted = places;
    std::ranges::sort(sorted);
    for (int k = 0; k < pattern.nodes(); ++k) ASSERT_EQ(sorted[k], k);

    const multigrid::Matrix<3> ordered(pattern, places), as_given(pattern);
    const std::vector<int> bounds = multigrid::groups_of_rows(ordered.rows(), 10);
    expect_bounds(ordered.rows(), bounds);
    EXPECT_GT(bounds.size(), 50U) << "about one for each of the sixty sheets of nodes across the box";
    expect_bounds(as_given.rows(), multigrid::groups_of_rows(as_given.rows(), 10));
  }
}

TEST(MultigridOrder, PiecesAndLoneNodesHavePlacesToo) {
  const BlockPattern pattern = pattern_of_groups(9, std::vector<int>{7, 2, 2, 5, 0, 8}, 2);  // 7-2-5, 0-8, lone ones
  std::vector<int> places = multigrid::places_by_distance(pattern);
  EXPECT_EQ(std::abs(places[7] - places[2]), 1);
  EXPECT_EQ(std::abs(places[5] - places[2]), 1);
  EXPECT_EQ(std::abs(places[0] - places[8]), 1);
  std::ranges::sort(places);
  for (int k = 0; k < 9; ++k) EXPECT_EQ(places[k], k);
  EXPECT_EQ(multigrid::groups_of_rows(multigrid::Matrix<3>(BlockPattern{}).rows(), 10), std::vector<int>{0});
}

// Sweeps that read a neighbour too early or too late would leave another residual than that of x.
TEST(MultigridOrder, SweepsGroupByGroupLeaveTheResidualOfWhatTheyFound) {
  const BlockPattern pattern = box(60, 20, 10, shuffled(60 * 20 * 10));
  support::Random random(5);
  std::vector<float> values;
  for (int row = 0; row < pattern.nodes(); ++row)
    for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at)
      for (int k = 0; k < 9; ++k)
        values.push_back(pattern.columns[at] != row ? static_cast<float>(random.number()) : k % 4 == 0 ? 100.0F : 0.0F);
  multigrid::Matrix<3> matrix(pattern, multigrid::places_by_distance(pattern));
  ASSERT_TRUE(matrix.set(values));
  EXPECT_GE(multigrid::groups_of_rows(matrix.rows(), 2048).size(), 6U) << "several groups are at work at once";
  multigrid::Smoother<3> smoother(matrix);
  ASSERT_TRUE(smoother.update());

  std::vector<float> b(matrix.unknowns());
  for (float& value : b) value = static_cast<float>(random.number());
  std::vector<float> first;
  for (const int threads : {1, 2, 4}) {
    const ThreadCount scope(threads);
    std::vector<float> r = b, x(b.size()), Ax(b.size());
    smoother.start(r, x);
    matrix.multiply(x, Ax);
    double error = 0, size = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      error += std::pow(r[i] - (b[i] - Ax[i]), 2);
      size += b[i] * b[i];
    }
    EXPECT_LT(std::sqrt(error / size), 1e-6);
    if (first.empty()) first = r;
    EXPECT_EQ(r, first) << threads << " threads";
  }
}

}  // namespace
}  // namespace plica
