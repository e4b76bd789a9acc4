// Direct solver, factors of blocks, products of panels.
#include "solver/algebra/linear_solver.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <thread>

#include "core/threads.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/algebra/panel_products.hpp"
#include "support/cubes.hpp"
#include "support/tissues.hpp"

namespace {

/// A random sparse quasi-definite matrix [A B^T; B -C], A and C positive definite, as pattern and values.
struct SmallSystem {
  SparsePattern pattern;
  std::vector<double> values;
  Eigen::MatrixXd full;
};

SmallSystem quasi_definite(int positive, int negative, Random& random) {
  const int size = positive + negative;
  SmallSystem system;
  system.full = Eigen::MatrixXd::Zero(size, size);
  for (int row = 0; row < size; ++row) {
    for (int column = 0; column <= row; ++column) {
      const bool mixed = row >= positive && column < positive;
      if (row != column && std::abs(random.number()) > (mixed ? 0.2 : 0.1)) continue;
      double value = random.number();
      if (row == column) value = (row < positive ? 1 : -1) * (4 + value);
      system.pattern.columns.push_back(column);
      system.values.push_back(value);
      system.full(row, column) = system.full(column, row) = value;
    }
    system.pattern.starts.push_back(static_cast<int>(system.pattern.columns.size()));
  }
  return system;
}

Eigen::VectorXd random_vector(int size, Random& random) {
  Eigen::VectorXd x(size);
  for (int i = 0; i < size; ++i) x[i] = random.number();
  return x;
}

TEST(DirectSolver, SolvesRandomQuasiDefiniteSystems) {
  Random random(1);
  for (const auto& [positive, negative] : {std::pair{3, 0}, {12, 3}, {120, 40}, {300, 100}}) {
    const SmallSystem system = quasi_definite(positive, negative, random);
    const Eigen::VectorXd exact = random_vector(positive + negative, random);
    Eigen::VectorXd x = system.full * exact;
    const auto solver = make_direct_solver();
    solver->analyse(system.pattern);
    ASSERT_TRUE(solver->factorise(system.values));
    solver->solve({x.data(), static_cast<std::size_t>(x.size())});
    EXPECT_LE((x - exact).norm(), 1e-10 * exact.norm());
  }
}

// A saddle point without the lower right block, as the step's system is; the zero diagonal is not in the pattern.
TEST(DirectSolver, SolvesASaddlePointWithoutItsDiagonal) {
  const SparsePattern pattern{{0, 1, 2, 4}, {0, 1, 0, 1}};
  const auto solver = make_direct_solver();
  solver->analyse(pattern);
  ASSERT_TRUE(solver->factorise(std::vector<double>{2, 4, 1, 1}));
  std::vector<double> x = {1, 2, 3};  // 2 x + z = 1, 4 y + z = 2, x + y = 3
  solver->solve(x);
  const std::vector<double> exact = {11.0 / 6, 7.0 / 6, -8.0 / 3};
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(x[i], exact[i], 1e-14);
}

TEST(DirectSolver, NewValuesOnOnePatternGiveTheSameBitsAsAFreshSolver) {
  Random random(2);
  const SmallSystem system = quasi_definite(100, 30, random);
  std::vector<double> others = system.values;
  for (double& value : others) value *= 1.1;
  Eigen::VectorXd first = random_vector(130, random), second = first;
  const auto used = make_direct_solver(), fresh = make_direct_solver();
  used->analyse(system.pattern);
  fresh->analyse(system.pattern);
  ASSERT_TRUE(used->factorise(others));
  ASSERT_TRUE(used->factorise(system.values));
  ASSERT_TRUE(fresh->factorise(system.values));
  used->solve({first.data(), 130});
  fresh->solve({second.data(), 130});
  EXPECT_EQ(first, second);
}

// Large enough for an orderer that works on several threads to do so.
TEST(DirectSolver, OrdersAlikeEveryTime) {
  constexpr int side = 24, size = side * side * side;
  SparsePattern pattern;
  std::vector<double> values;
  const auto entry = [&](int row, int column, double value) {
    pattern.columns.push_back(column);
    values.push_back(value);
    if (column == row) pattern.starts.push_back(static_cast<int>(pattern.columns.size()));
  };
  for (int i = 0; i < size; ++i) {  // the Laplacian of a cube, and a little
    if (i >= side * side) entry(i, i - side * side, -1);
    if (i / side % side > 0) entry(i, i - side, -1);
    if (i % side > 0) entry(i, i - 1, -1);
    entry(i, i, 6.5);
  }
  Random random(3);
  const Eigen::VectorXd right = random_vector(size, random);
  Eigen::VectorXd first;
  for (int run = 0; run < 6; ++run) {
    const auto solver = make_direct_solver();
    solver->analyse(pattern);
    ASSERT_TRUE(solver->factorise(values));
    Eigen::VectorXd x = right;
    solver->solve({x.data(), size});
    if (run == 0) first = x;
    EXPECT_EQ(x, first) << run;
  }
}

TEST(DirectSolver, SaysWhenTheMatrixIsSingular) {
  const auto solver = make_direct_solver();
  solver->analyse({{0, 1, 3}, {0, 0, 1}});
  EXPECT_FALSE(solver->factorise(std::vector<double>{0, 0, 0}));
  EXPECT_TRUE(solver->factorise(std::vector<double>{1, 0, 1})) << "a failure must not be the last word";
}

// MUMPS and METIS keep things to themselves: two solvers in two threads give what they give alone.
TEST(DirectSolver, TwoInTwoThreadsDoNotDisturbEachOther) {
  Random random(5);
  std::vector<SmallSystem> systems;
  std::vector<Eigen::VectorXd> rights;
  for (int k = 0; k < 2; ++k) {
    systems.push_back(quasi_definite(200, 60, random));
    rights.push_back(random_vector(260, random));
  }
  const auto solve = [&](int k) {
    Eigen::VectorXd x = rights[k];
    const auto solver = make_direct_solver();
    solver->analyse(systems[k].pattern);
    EXPECT_TRUE(solver->factorise(systems[k].values));
    solver->solve({x.data(), static_cast<std::size_t>(x.size())});
    return x;
  };
  const std::vector<Eigen::VectorXd> alone = {solve(0), solve(1)};
  int wrong = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Eigen::VectorXd> together(2);
    std::thread other([&] { together[1] = solve(1); });
    together[0] = solve(0);
    other.join();
    for (const int k : {0, 1}) wrong += together[k] != alone[k];
  }
  EXPECT_EQ(wrong, 0);
}

/// A box of nodes, each a neighbour of those of its cubes, with random blocks: symmetric, positive definite.
struct BlockSystem {
  BlockSystem(int nx, int ny, int nz) {
    pattern = pattern_of_groups(nx * ny * nz, cubes_of_box(nx, ny, nz), 8);
    Random random(7);
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
  for (const auto& [nx, ny, nz] : sizes) {
    const BlockSystem system(nx, ny, nz);
    for (const Kernels kernels : available_kernels()) {
      BlockCholesky cholesky(system.pattern, kernels);
      ASSERT_TRUE(cholesky.factorise(system.values));
      auto x = system.b;
      cholesky.solve(x);
      EXPECT_LT(system.error(x), 2e-6) << nx << " x " << ny << " x " << nz << ", " << name(kernels);
    }
  }
}

TEST(BlockCholesky, GivesTheSameBitsAgainAndAfterAnotherMatrix) {
  const BlockSystem system(12, 9, 3);
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
  const BlockSystem system(20, 16, 2);
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

// The box once more, in the order of one without some cubes and of one with all nodes apart.
TEST(BlockCholesky, TakesTheOrderOfAnotherPattern) {
  const BlockSystem system(12, 9, 3);
  const std::vector<int> cubes = cubes_of_box(12, 9, 3);
  std::vector<int> fewer;
  for (std::size_t k = 0; k < cubes.size(); ++k)
    if (k / 8 % 12 != 5) fewer.push_back(cubes[k]);
  const int nodes = system.pattern.nodes();
  const BlockCholesky similar(pattern_of_groups(nodes, fewer, 8)), apart(pattern_of_groups(nodes, {}, 8));
  const std::size_t own_size = BlockCholesky(system.pattern).factor_size();
  for (const BlockCholesky* other : {&similar, &apart}) {
    BlockCholesky cholesky(system.pattern, chosen_kernels(), other->positions());
    ASSERT_TRUE(cholesky.factorise(system.values));
    auto x = system.b;
    cholesky.solve(x);
    EXPECT_LT(system.error(x), 2e-6);
    EXPECT_GE(cholesky.factor_size(), own_size / 2);
    if (other == &similar) {
      EXPECT_LT(cholesky.factor_size(), 3 * own_size / 2);
    }
  }
}

TEST(BlockCholesky, KeepsLessThanTheDenseFactor) {
  const BlockSystem system(24, 20, 2);
  const BlockCholesky cholesky(system.pattern);
  const auto rows = static_cast<std::size_t>(system.matrix.rows());
  EXPECT_LT(cholesky.factor_size(), rows * rows / 5);
}

TEST(BlockCholesky, GivesTheSameBitsOnAnyNumberOfThreads) {
  // Large enough for subtrees of the factor to be shared out; and of the solves.
  const BlockSystem large(60, 60, 2);
  ASSERT_GT(BlockCholesky(large.pattern).factor_size(), BlockCholesky::worth_sharing);
  for (const BlockSystem& system : {BlockSystem(20, 16, 2), large}) {
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
    for (BlockSystem system : {BlockSystem(6, 5, 2), BlockSystem(20, 16, 2)}) {
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

// As a supernode keeps it: [lower triangle; any numbers], padded with zeros to whole chunks.
struct Example {
  Example(int width, int rows) : dense(Eigen::MatrixXf::Zero(rows, width)), chunks(width * chunks_for(rows)) {
    Random random(11);
    for (int j = 0; j < width; ++j)
      for (int i = j; i < rows; ++i) {
        dense(i, j) = static_cast<float>(random.number());
        chunks[j * chunks_for(rows)].numbers[i] = dense(i, j);
      }
  }
  [[nodiscard]] Panel panel() const {
    return {chunks.data(), chunks_for(dense.rows()), static_cast<int>(dense.cols())};
  }

  Eigen::MatrixXf dense;
  std::vector<PanelChunk> chunks;
};

// Widths on both sides of six columns at once, heights on both sides of a chunk and of several.
constexpr int shapes[][2] = {{3, 3}, {3, 40}, {6, 16}, {6, 17}, {9, 9}, {12, 100}, {15, 48}, {21, 31}, {33, 210}};

TEST(PanelProducts, AreThoseOfTheDenseMatrixForAnyKernels) {
  for (const Kernels kernels : available_kernels())
    for (const auto& [width, rows] : shapes) {
      const Example example(width, rows);
      const auto& [multiply, multiply_transposed] = panel_products(kernels);
      const std::size_t height = chunks_for(rows), size = PanelChunk::size * height;
      const Eigen::VectorXf x = Eigen::VectorXf::LinSpaced(width, -1, 2);

      constexpr float none = std::numeric_limits<float>::quiet_NaN();  // what is not written shows
      std::vector<PanelChunk> y(height);
      std::fill_n(y.front().numbers, size, none);
      multiply(example.panel(), x.data(), y.data());
      Eigen::Map<Eigen::VectorXf> numbers(y.front().numbers, static_cast<Eigen::Index>(size));
      EXPECT_LT((numbers.head(rows) - example.dense * x).cwiseAbs().maxCoeff(), 1e-5F) << name(kernels);
      EXPECT_TRUE((numbers.tail(numbers.size() - rows).array() == 0).all()) << name(kernels);

      numbers.head(rows).setLinSpaced(-2, 3);
      Eigen::VectorXf back = Eigen::VectorXf::Constant(width, none);
      multiply_transposed(example.panel(), y.data(), back.data());
      EXPECT_LT((back - example.dense.transpose() * numbers.head(rows)).cwiseAbs().maxCoeff(), 1e-4F) << name(kernels);
    }
}

}  // namespace
