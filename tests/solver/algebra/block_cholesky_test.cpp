#include "solver/algebra/block_cholesky.hpp"

#include <gtest/gtest.h>

#include <Eigen/Sparse>
#include <utility>
#include <vector>

#include "core/threads.hpp"
#include "support/cubes.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

/// A box of nodes, each a neighbour of those of its cubes, with random blocks: symmetric, positive definite.
struct System {
  System(int nx, int ny, int nz) {
    pattern = pattern_of_groups(nx * ny * nz, support::cubes_of_box(nx, ny, nz), 8);
    support::Random random(7);
    std::vector<Eigen::Triplet<double>> numbers;
    for (int row = 0; row < pattern.nodes(); ++row)
      for (int at = pattern.starts[row]; at < pattern.starts[row + 1]; ++at) {
        Mat3 block;
        for (int k = 0; k < 9; ++k) block.data()[k] = random.number();
        if (pattern.columns[at] == row) block = (block + block.transpose() + 60 * Mat3::Identity()).eval();
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) {
            values.push_back(static_cast<float>(block(i, j)));
            numbers.emplace_back(3 * row + i, 3 * pattern.columns[at] + j, block(i, j));
          }
      }
    matrix.resize(3 * pattern.nodes(), 3 * pattern.nodes());
    matrix.setFromTriplets(numbers.begin(), numbers.end());
    for (int n = 0; n < matrix.rows(); ++n) b.push_back(static_cast<float>(random.number()));
  }

  [[nodiscard]] double error(const std::vector<float>& x) const {
    const Eigen::VectorXd exact = Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(matrix).solve(
        Eigen::Map<const Eigen::VectorXf>(b.data(), matrix.rows()).cast<double>());
    return (Eigen::Map<const Eigen::VectorXf>(x.data(), matrix.rows()).cast<double>() - exact).norm() / exact.norm();
  }

  BlockPattern pattern;
  std::vector<float> values, b;
  Eigen::SparseMatrix<double> matrix;  // its lower triangle
};

TEST(BlockCholesky, AgreesWithASolveInDoublePrecision) {
  const std::array<int, 3> sizes[] = {{2, 2, 2}, {9, 1, 1}, {4, 3, 2}, {12, 9, 2}, {7, 6, 8}, {20, 16, 2}, {60, 60, 2}};
  int cases = 0;
  for (const auto& [nx, ny, nz] : sizes) {
    const System system(nx, ny, nz);
    for (const Kernels kernels : available_kernels()) {
      BlockCholesky cholesky(system.pattern, kernels);
      ASSERT_TRUE(cholesky.factorise(system.values));
      auto x = system.b;
      cholesky.solve(x);
      EXPECT_LT(system.error(x), 2e-6) << nx << " x " << ny << " x " << nz << ", " << name(kernels);
    }
    ++cases;
  }
  EXPECT_EQ(cases, 7);
}

TEST(BlockCholesky, GivesTheSameBitsAgainAndAfterAnotherMatrix) {
  const System system(12, 9, 3);
  BlockCholesky cholesky(system.pattern), another(system.pattern);
  ASSERT_TRUE(cholesky.factorise(system.values));
  auto x = system.b, y = system.b;
  cholesky.solve(x);
  auto doubled = system.values;
  for (float& value : doubled) value *= 2;
  ASSERT_TRUE(another.factorise(doubled));
  another.solve(y);
  ASSERT_TRUE(another.factorise(system.values));
  y = system.b;
  another.solve(y);
  EXPECT_EQ(x, y);
}

// y^T z = b^T A^-1 c, also where most of b is zero, which makes most of y zero.
TEST(BlockCholesky, HalvesOfASolveMakeProducts) {
  const System system(20, 16, 2);
  BlockCholesky cholesky(system.pattern);
  ASSERT_TRUE(cholesky.factorise(system.values));
  std::vector<float> b(system.b.size(), 0.0F);
  for (int i = 300; i < 303; ++i) b[i] = 1;
  BlockCholesky::Halfway y, z;
  cholesky.solve_down(b, y);
  cholesky.solve_down(system.b, z);
  double product = 0;
  int nodes = 0;
  for (std::size_t n = 0; n < y.size(); ++n) {
    const Eigen::Map<const Eigen::Vector3f> of_y(y[n].numbers), of_z(z[n].numbers);
    product += of_y.cast<double>().dot(of_z.cast<double>());
    nodes += of_y != Eigen::Vector3f::Zero();
  }
  auto x = system.b;
  cholesky.solve(x);
  EXPECT_NEAR(product, double(x[300]) + x[301] + x[302], 1e-6);
  EXPECT_GT(nodes, 0);
  EXPECT_LT(nodes, system.pattern.nodes() / 2);
}

TEST(BlockCholesky, KeepsLessThanTheDenseFactor) {
  const System system(24, 20, 2);
  const BlockCholesky cholesky(system.pattern);
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  EXPECT_LT(cholesky.factor_size(), rows * rows / 5);
}

TEST(BlockCholesky, GivesTheSameBitsOnAnyNumberOfThreads) {
  // Large enough for subtrees of the factor to be shared out; and of the solves.
  const System large(60, 60, 2);
  ASSERT_GT(BlockCholesky(large.pattern).factor_size(), BlockCholesky::worth_sharing);
  for (const System& system : {System(20, 16, 2), large}) {
    std::vector<float> on_one;
    for (const int threads : {1, 2, 3, 8}) {
      const ThreadCount scope(threads);
      BlockCholesky cholesky(system.pattern);
      ASSERT_TRUE(cholesky.factorise(system.values));
      auto x = system.b;
      cholesky.solve(x);
      if (threads == 1) on_one = x;
      EXPECT_EQ(x, on_one) << threads << " threads";
    }
  }
}

TEST(BlockCholesky, SaysWhenAMatrixIsNotPositiveDefinite) {
  for (const int threads : {1, 2}) {
    const ThreadCount scope(threads);
    for (System system : {System(6, 5, 2), System(20, 16, 2)}) {
      BlockCholesky cholesky(system.pattern);
      float& value = system.values[9 * static_cast<std::size_t>(system.pattern.find(17, 17)) + 4];
      const float was = std::exchange(value, -60.0F);
      EXPECT_FALSE(cholesky.factorise(system.values));
      value = was;
      ASSERT_TRUE(cholesky.factorise(system.values));
      auto x = system.b;
      cholesky.solve(x);
      EXPECT_LT(system.error(x), 2e-6);
    }
  }
}

TEST(BlockCholesky, PatternHasEachPairOfAGroupOnce) {
  const BlockPattern pattern = pattern_of_groups(4, std::vector<int>{0, 2, 2, 3, 0, 2}, 2);
  EXPECT_EQ(pattern.starts, (std::vector<int>{0, 1, 2, 4, 6}));
  EXPECT_EQ(pattern.columns, (std::vector<int>{0, 1, 0, 2, 2, 3}));
  EXPECT_EQ(pattern.find(2, 0), 2);
  EXPECT_THROW((void)pattern.find(3, 0), std::out_of_range);
}

}  // namespace
}  // namespace plica
