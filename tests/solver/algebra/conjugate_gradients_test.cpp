#include "solver/algebra/conjugate_gradients.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/tissues.hpp"

namespace plica {
namespace {

constexpr int nodes = 12;
using Matrix = Eigen::Matrix<double, 3 * nodes, 3 * nodes>;
using Vector = Eigen::Matrix<double, 3 * nodes, 1>;

Vector flat(const Vectors& vectors) {
  Vector result;
  for (int n = 0; n < nodes; ++n) result.segment<3>(3 * n) = vectors[n];
  return result;
}

/// A random symmetric positive definite matrix and ways to use it.
struct System {
  System() {
    support::Random random(1);
    for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = random.number();
    matrix = (matrix * matrix.transpose() + 0.1 * Matrix::Identity()).eval();
    b = random.vectors(nodes);
  }
  [[nodiscard]] auto multiply() const {
    return [this](const Vectors& x, Vectors& product) {
      const Vector y = matrix * flat(x);
      for (int n = 0; n < nodes; ++n) product[n] = y.segment<3>(3 * n);
    };
  }
  Matrix matrix;
  Vectors b;
};

void same(const Vectors& r, Vectors& z) { z = r; }

TEST(ConjugateGradients, SolveToTheirTolerance) {
  const System system;
  int previous = 0;
  for (const double tolerance : {1e-3, 1e-6, 1e-10}) {
    Vectors x;
    const auto report = conjugate_gradients(system.multiply(), same, system.b, tolerance, 500, {}, x);
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
  const auto precondition = [&](const Vectors& r, Vectors& z) {
    const Vector y = inverse * flat(r);
    for (int n = 0; n < nodes; ++n) z[n] = y.segment<3>(3 * n);
  };
  Vectors x;
  EXPECT_EQ(conjugate_gradients(system.multiply(), precondition, system.b, 1e-9, 500, {}, x).iterations, 1);
}

TEST(ConjugateGradients, SayWhenTheyDoNotGetThere) {
  const System system;
  Vectors x;
  auto report = conjugate_gradients(system.multiply(), same, system.b, 1e-12, 3, {}, x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  report = conjugate_gradients(
      system.multiply(), same, system.b, 1e-12, 500, [] { return true; }, x);
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.converged);
  Vectors bad = system.b;
  bad[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(conjugate_gradients(system.multiply(), same, bad, 1e-6, 500, {}, x).converged);
}

TEST(ConjugateGradients, NothingToSolveIsSolved) {
  const System system;
  Vectors x;
  const auto report = conjugate_gradients(system.multiply(), same, Vectors(nodes, Vec3::Zero()), 1e-6, 500, {}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(flat(x).norm(), 0);
}

}  // namespace
}  // namespace plica
