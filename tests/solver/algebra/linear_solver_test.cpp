#include "solver/algebra/linear_solver.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "support/tissues.hpp"

namespace plica {
namespace {

using support::Random;

/// A random sparse quasi-definite matrix [A B^T; B -C], A and C positive definite, as pattern and values.
struct System {
  Rows pattern;
  std::vector<double> values;
  Eigen::MatrixXd full;
};

System quasi_definite(int positive, int negative, Random& random) {
  const int size = positive + negative;
  System system;
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
  int cases = 0;
  for (const auto& [positive, negative] : {std::pair{3, 0}, {12, 3}, {120, 40}, {300, 100}}) {
    const System system = quasi_definite(positive, negative, random);
    const Eigen::VectorXd exact = random_vector(positive + negative, random);
    Eigen::VectorXd x = system.full * exact;
    const auto solver = make_direct_solver();
    solver->analyse(system.pattern);
    ASSERT_TRUE(solver->factorise(system.values));
    solver->solve({x.data(), static_cast<std::size_t>(x.size())});
    EXPECT_LE((x - exact).norm(), 1e-10 * exact.norm());
    ++cases;
  }
  RecordProperty("cases", cases);
}

// A saddle point without the lower right block, as the step's system is; the zero diagonal is not in the pattern.
TEST(DirectSolver, SolvesASaddlePointWithoutItsDiagonal) {
  const Rows pattern{{0, 1, 2, 4}, {0, 1, 0, 1}};
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
  const System system = quasi_definite(100, 30, random);
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
  Rows pattern;
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
  std::vector<System> systems;
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

}  // namespace
}  // namespace plica
