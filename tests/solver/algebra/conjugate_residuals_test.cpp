#include <gtest/gtest.h>

#include <limits>

#include "solver/algebra/krylov.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

constexpr int size = 40;
using Matrix = Eigen::Matrix<double, size, size>;
using Vector = KrylovVector;
using Map = Eigen::Map<const Eigen::Matrix<double, size, 1>>;

/// A random matrix without symmetry, its eigenvalues on both sides of zero.
struct System {
  System() {
    support::Random random(1);
    for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = 0.1 * random.number();
    for (int i = 0; i < size; ++i) matrix(i, i) += i % 3 == 0 ? -1 : 1;
    for (int i = 0; i < size; ++i) b.push_back(random.number());
  }
  [[nodiscard]] auto times(const Matrix& factor) const {
    return [factor](const Vector& x, Vector& product) {
      Eigen::Map<Eigen::Matrix<double, size, 1>>(product.data()) = factor * Map(x.data());
    };
  }
  [[nodiscard]] KrylovReport solve(const KrylovRule& rule, Vector& x) const {
    return ConjugateResiduals().solve(times(matrix), times(Matrix::Identity()), b, rule, {}, x);
  }
  [[nodiscard]] double error(const Vector& x) const {
    return (Map(b.data()) - matrix * Map(x.data())).norm() / Map(b.data()).norm();
  }
  Matrix matrix;
  Vector b;
};

TEST(ConjugateResiduals, SolveToTheirToleranceInNoMoreIterationsThanUnknowns) {
  const System system;
  int previous = 0;
  for (const double tolerance : {1e-2, 1e-6, 1e-10}) {
    Vector x;
    const auto report = system.solve({.tolerance = tolerance, .most_kept = size}, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(system.error(x), 1.01 * tolerance);
    EXPECT_GT(report.iterations, previous);
    EXPECT_LE(report.iterations, size);
    previous = report.iterations;
  }
}

TEST(ConjugateResiduals, KeepingFewDirectionsTakesLongerAndGetsThere) {
  System system;
  system.matrix += 1.5 * Matrix::Identity();
  Vector all, few;
  const auto kept_all = system.solve({.tolerance = 1e-8, .most_iterations = 2000, .most_kept = size}, all);
  const auto kept_few = system.solve({.tolerance = 1e-8, .most_iterations = 2000, .most_kept = 5}, few);
  EXPECT_TRUE(kept_few.converged);
  EXPECT_LE(system.error(few), 1.01e-8);
  EXPECT_GE(kept_few.iterations, kept_all.iterations);
}

TEST(ConjugateResiduals, TheExactInverseNeedsOneIteration) {
  const System system;
  Vector x;
  const auto report = ConjugateResiduals().solve(system.times(system.matrix), system.times(system.matrix.inverse()),
                                                 system.b, {.tolerance = 1e-9}, {}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
}

// Nothing is lost when a better preconditioner takes over on the way.
TEST(ConjugateResiduals, GoOnWithAnotherPreconditioner) {
  const System system;
  const Matrix inverse = system.matrix.inverse();
  Vector x;
  double residual = 1;
  bool is_exact = false;
  const auto report = ConjugateResiduals().solve(
      system.times(system.matrix),
      [&](const Vector& r, Vector& z) { system.times(is_exact ? inverse : Matrix(Matrix::Identity()))(r, z); },
      system.b, {.tolerance = 1e-9},
      [&](const KrylovReport& so_far) {
        EXPECT_LE(so_far.residual, residual);
        residual = so_far.residual;
        is_exact = so_far.iterations == 5;
        return true;
      },
      x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 6);
  EXPECT_LE(system.error(x), 1e-8);
}

TEST(ConjugateResiduals, SayWhenTheyDoNotGetThere) {
  const System system;
  Vector x;
  auto report = system.solve({.tolerance = 1e-12, .most_iterations = 3}, x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  report = ConjugateResiduals().solve(
      system.times(system.matrix), system.times(Matrix::Identity()), system.b, {}, [](const auto&) { return false; },
      x);
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(ConjugateResiduals()
                   .solve(system.times(system.matrix), system.times(Matrix::Zero()), system.b, {}, {}, x)
                   .converged);
  System bad;
  bad.b[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bad.solve({}, x).converged);
}

TEST(ConjugateResiduals, NothingToSolveIsSolved) {
  System system;
  system.b.assign(size, 0.0);
  Vector x;
  const auto report = system.solve({}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, system.b);
}

}  // namespace
}  // namespace plica
