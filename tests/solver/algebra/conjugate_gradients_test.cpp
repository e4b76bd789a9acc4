#include <gtest/gtest.h>

#include <limits>

#include "solver/algebra/krylov.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

constexpr int nodes = 12;
using Matrix = Eigen::Matrix<double, 3 * nodes, 3 * nodes>;
using Vector = Eigen::Matrix<double, 3 * nodes, 1>;

Eigen::Map<const Vector> flat(const KrylovVector& numbers) { return Eigen::Map<const Vector>(numbers.data()); }
Eigen::Map<Vector> flat(KrylovVector& numbers) { return Eigen::Map<Vector>(numbers.data()); }

/// A random symmetric positive definite matrix and ways to use it.
struct System {
  System() {
    support::Random random(1);
    for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = random.number();
    matrix = (matrix * matrix.transpose() + 0.1 * Matrix::Identity()).eval();
    for (int i = 0; i < 3 * nodes; ++i) b.push_back(random.number());
  }
  [[nodiscard]] auto multiply() const {
    return [this](const KrylovVector& x, KrylovVector& product) { flat(product) = matrix * flat(x); };
  }
  Matrix matrix;
  KrylovVector b;
};

void same(const KrylovVector& r, KrylovVector& z) { z = r; }

TEST(ConjugateGradients, SolveToTheirTolerance) {
  const System system;
  int previous = 0;
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    KrylovVector x;
    const auto report =
        conjugate_gradients(system.multiply(), same, system.b, {.tolerance = tolerance, .most_iterations = 500}, {}, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(report.residual, tolerance);
    EXPECT_LE((flat(system.b) - system.matrix * flat(x)).norm(), 1.01 * tolerance * flat(system.b).norm());
    EXPECT_GT(report.iterations, previous);
    previous = report.iterations;
  }
}

TEST(ConjugateGradients, TheExactInverseNeedsOneIteration) {
  const System system;
  const Matrix inverse = system.matrix.inverse();
  const auto precondition = [&](const KrylovVector& r, KrylovVector& z) { flat(z) = inverse * flat(r); };
  KrylovVector x;
  EXPECT_EQ(
      conjugate_gradients(system.multiply(), precondition, system.b, {.tolerance = 1e-9, .most_iterations = 500}, {}, x)
          .iterations,
      1);
}

TEST(ConjugateGradients, SayWhenTheyDoNotGetThere) {
  const System system;
  KrylovVector x;
  auto report =
      conjugate_gradients(system.multiply(), same, system.b, {.tolerance = 1e-12, .most_iterations = 3}, {}, x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  report = conjugate_gradients(
      system.multiply(), same, system.b, {.tolerance = 1e-12}, [](const KrylovReport&) { return false; }, x);
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.converged);
  KrylovVector bad = system.b;
  bad[10] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(
      conjugate_gradients(system.multiply(), same, bad, {.tolerance = 1e-6, .most_iterations = 500}, {}, x).converged);
}

TEST(ConjugateGradients, NothingToSolveIsSolved) {
  const System system;
  KrylovVector x;
  const auto report = conjugate_gradients(system.multiply(), same, KrylovVector(3 * nodes, 0.0),
                                          {.tolerance = 1e-6, .most_iterations = 500}, {}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(flat(x).norm(), 0);
}

}  // namespace
}  // namespace plica
