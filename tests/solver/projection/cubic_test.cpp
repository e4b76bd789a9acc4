#include "solver/projection/cubic.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdio>

#include "support/tissues.hpp"

namespace plica {
namespace {

/// c (l - a)(l - b)(l - d), with c such that the slope at zero is positive.
Cubic with_roots(double a, double b, double d) {
  const double c = a * b + b * d + d * a > 0 ? 1 : -1;
  return {c, -c * (a + b + d), c * (a * b + b * d + d * a), -c * a * b * d};
}

TEST(Cubic, RootNearestZeroOfThreeIsFound) {
  int cases = 0;
  for (const std::array<double, 3>& roots : {std::array<double, 3>{1, 2, 3},
                                             {-1, 2, 3},
                                             {-1, -2, -3},
                                             {0.5, -4, 7},
                                             {-0.1, 0.2, 50},
                                             {1e-9, 5, -8},
                                             {2, -1.5, 0.7},
                                             {3, -2.9, 40}}) {
    double nearest = roots[0];
    for (const double root : roots)
      if (std::abs(root) < std::abs(nearest)) nearest = root;
    const Cubic cubic = with_roots(roots[0], roots[1], roots[2]);
    ASSERT_GT(cubic.c1, 0);
    const auto found = root_nearest_zero(cubic);
    ASSERT_TRUE(found);
    EXPECT_NEAR(*found, nearest, 1e-14 * std::abs(nearest)) << roots[0] << " " << roots[1] << " " << roots[2];
    EXPECT_TRUE(has_three_real_roots(cubic));
    ++cases;
  }
  EXPECT_EQ(cases, 8);
}

// A volume that is off by 1e-9 of itself: formulas with cube roots leave no digit of this.
TEST(Cubic, TinyRootsKeepTheirDigits) {
  for (const double excess : {1e-3, 1e-9, 1e-15, -1e-12}) {
    const Cubic cubic{2, 30, 45, 45 * excess};
    const double root = root_nearest_zero(cubic).value();
    EXPECT_LE(std::abs(cubic.at(root)), 1e-14 * 45 * std::abs(excess));
    EXPECT_NEAR(root / -excess, 1, 2 * std::abs(excess) + 1e-14);  // the linear part's root and a first correction
  }
  EXPECT_EQ(root_nearest_zero({2, 30, 45, 0}).value(), 0);
}

TEST(Cubic, LowerDegreesAreSolvedToo) {
  EXPECT_DOUBLE_EQ(root_nearest_zero({0, 0, 4, -2}).value(), 0.5);
  EXPECT_NEAR(root_nearest_zero({0, 1, 4, 3}).value(), -1, 1e-14);
  EXPECT_FALSE(root_nearest_zero({0, 1, 1, 3}));
  EXPECT_FALSE(has_three_real_roots({0, 1, 4, 3}));
}

// Against the eigenvalues of the companion matrix.
TEST(Cubic, AgreesWithCompanionMatrix) {
  support::Random random(1);
  int three = 0, cases = 0;
  for (int k = 0; k < 2000; ++k) {
    const Cubic cubic{random.number(3), random.number(5), 0.01 + std::abs(random.number(4)), random.number(6)};
    Mat3 companion;
    companion << 0, 0, -cubic.c0 / cubic.c3, 1, 0, -cubic.c1 / cubic.c3, 0, 1, -cubic.c2 / cubic.c3;
    const Eigen::EigenSolver<Mat3> solver(companion, false);
    double nearest = INFINITY;
    int real = 0;
    bool doubtful = false;  // two roots about equal, or equally near: either answer is right
    for (int i = 0; i < 3; ++i) {
      const std::complex<double> root = solver.eigenvalues()[i];
      for (int j = 0; j < i; ++j) {
        doubtful = doubtful || std::abs(root - solver.eigenvalues()[j]) < 1e-5 * std::abs(root);
        doubtful = doubtful || std::abs(std::abs(root.real()) - std::abs(solver.eigenvalues()[j].real())) < 1e-9;
      }
      if (std::abs(root.imag()) > 1e-9 * std::abs(root)) continue;
      ++real;
      if (std::abs(root.real()) < std::abs(nearest)) nearest = root.real();
    }
    if (doubtful && real == 3) continue;
    EXPECT_NEAR(root_nearest_zero(cubic).value(), nearest, 1e-8 * std::abs(nearest));
    EXPECT_EQ(has_three_real_roots(cubic), real == 3);
    three += real == 3;
    ++cases;
  }
  std::printf("%d random cubics, %d with three real roots\n", cases, three);
  EXPECT_GT(cases, 1900);
  EXPECT_GT(three, 100);
}

}  // namespace
}  // namespace plica
