// Conjugate gradients and conjugate residuals.
#include "solver/algebra/krylov.hpp"

#include "support/tissues.hpp"

namespace {

constexpr int nodes = 12;
using Matrix = Eigen::Matrix<double, 3 * nodes, 3 * nodes>;
using Vector = Eigen::Matrix<double, 3 * nodes, 1>;

Eigen::Map<const Vector> flat(const KrylovVector& numbers) { return Eigen::Map<const Vector>(numbers.data()); }
Eigen::Map<Vector> flat(KrylovVector& numbers) { return Eigen::Map<Vector>(numbers.data()); }

/// A random symmetric positive definite matrix and ways to use it.
struct System {
  System() {
    Random random(1);
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

constexpr int size = 40;
using DenseMatrix = Eigen::Matrix<double, size, size>;
using Unknowns = KrylovVector;
using Map = Eigen::Map<const Eigen::Matrix<double, size, 1>>;

/// A random matrix without symmetry, its eigenvalues on both sides of zero.
struct DenseSystem {
  DenseSystem() {
    Random random(1);
    for (int i = 0; i < matrix.size(); ++i) matrix.data()[i] = 0.1 * random.number();
    for (int i = 0; i < size; ++i) matrix(i, i) += i % 3 == 0 ? -1 : 1;
    for (int i = 0; i < size; ++i) b.push_back(random.number());
  }
  [[nodiscard]] auto times(const DenseMatrix& factor) const {
    return [factor](const Unknowns& x, Unknowns& product) {
      Eigen::Map<Eigen::Matrix<double, size, 1>>(product.data()) = factor * Map(x.data());
    };
  }
  [[nodiscard]] KrylovReport solve(const KrylovRule& rule, Unknowns& x) const {
    return ConjugateResiduals().solve(times(matrix), times(DenseMatrix::Identity()), b, rule, {}, x);
  }
  [[nodiscard]] double error(const Unknowns& x) const {
    return (Map(b.data()) - matrix * Map(x.data())).norm() / Map(b.data()).norm();
  }
  DenseMatrix matrix;
  Unknowns b;
};

TEST(ConjugateResiduals, SolveToTheirToleranceInNoMoreIterationsThanUnknowns) {
  const DenseSystem system;
  int previous = 0;
  for (const double tolerance : {1e-2, 1e-6, 1e-10}) {
    Unknowns x;
    const auto report = system.solve({.tolerance = tolerance, .most_kept = size}, x);
    EXPECT_TRUE(report.converged);
    EXPECT_LE(system.error(x), 1.01 * tolerance);
    EXPECT_GT(report.iterations, previous);
    EXPECT_LE(report.iterations, size);
    previous = report.iterations;
  }
}

TEST(ConjugateResiduals, KeepingFewDirectionsTakesLongerAndGetsThere) {
  DenseSystem system;
  system.matrix += 1.5 * DenseMatrix::Identity();
  Unknowns all, few;
  const auto kept_all = system.solve({.tolerance = 1e-8, .most_iterations = 2000, .most_kept = size}, all);
  const auto kept_few = system.solve({.tolerance = 1e-8, .most_iterations = 2000, .most_kept = 5}, few);
  EXPECT_TRUE(kept_few.converged);
  EXPECT_LE(system.error(few), 1.01e-8);
  EXPECT_GE(kept_few.iterations, kept_all.iterations);
}

TEST(ConjugateResiduals, TheExactInverseNeedsOneIteration) {
  const DenseSystem system;
  Unknowns x;
  const auto report = ConjugateResiduals().solve(system.times(system.matrix), system.times(system.matrix.inverse()),
                                                 system.b, {.tolerance = 1e-9}, {}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
}

// Nothing is lost when a better preconditioner takes over on the way.
TEST(ConjugateResiduals, GoOnWithAnotherPreconditioner) {
  const DenseSystem system;
  const DenseMatrix inverse = system.matrix.inverse();
  Unknowns x;
  double residual = 1;
  bool is_exact = false;
  const auto report = ConjugateResiduals().solve(
      system.times(system.matrix),
      [&](const Unknowns& r, Unknowns& z) {
        system.times(is_exact ? inverse : DenseMatrix(DenseMatrix::Identity()))(r, z);
      },
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
  const DenseSystem system;
  Unknowns x;
  auto report = system.solve({.tolerance = 1e-12, .most_iterations = 3}, x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 3);
  report = ConjugateResiduals().solve(
      system.times(system.matrix), system.times(DenseMatrix::Identity()), system.b, {},
      [](const auto&) { return false; }, x);
  EXPECT_TRUE(report.interrupted);
  EXPECT_FALSE(report.converged);
  EXPECT_FALSE(ConjugateResiduals()
                   .solve(system.times(system.matrix), system.times(DenseMatrix::Zero()), system.b, {}, {}, x)
                   .converged);
  DenseSystem bad;
  bad.b[3] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bad.solve({}, x).converged);
}

TEST(ConjugateResiduals, NothingToSolveIsSolved) {
  DenseSystem system;
  system.b.assign(size, 0.0);
  Unknowns x;
  const auto report = system.solve({}, x);
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x, system.b);
}

}  // namespace
