#include "tissue/shapes/solid_harmonics.hpp"

#include <gtest/gtest.h>

#include "tissue/shapes/star_surface.hpp"

namespace plica {
namespace {

double value(const std::vector<double>& coefficients, int degree, const Vec3& direction) {
  HarmonicValues values;
  evaluate_harmonics(direction, degree, values);
  double sum = 0;
  for (std::size_t i = 0; i < harmonic_count(degree); ++i) sum += coefficients[i] * values[i];
  return sum;
}

TEST(SolidHarmonics, AreTheKnownPolynomials) {
  const Vec3 d = Vec3(0.3, -0.5, 0.8).normalized();
  HarmonicValues values;
  evaluate_harmonics(d, 3, values);
  EXPECT_DOUBLE_EQ(values[0], 1);
  EXPECT_NEAR(values[1], d.y() / 2, 1e-15);
  EXPECT_NEAR(values[2], d.z(), 1e-15);
  EXPECT_NEAR(values[3], d.x() / 2, 1e-15);
  EXPECT_NEAR(values[6], (3 * d.z() * d.z() - 1) / 4, 1e-15);
  EXPECT_NEAR(values[8], (d.x() * d.x() - d.y() * d.y()) / 8, 1e-15);
  EXPECT_NEAR(values[12], (5 * d.z() * d.z() * d.z() - 3 * d.z()) / 12, 1e-15);
}

TEST(SolidHarmonics, AreOrthogonalWithMeanSquareOne) {
  constexpr int degree = 5;
  const std::vector<double> norms = harmonic_norms(degree);
  const Vectors directions = even_directions(20'000);
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(harmonic_count(degree), harmonic_count(degree));
  for (const Vec3& direction : directions) {
    HarmonicValues values;
    evaluate_harmonics(direction, degree, values);
    Eigen::VectorXd row(harmonic_count(degree));
    for (std::size_t i = 0; i < harmonic_count(degree); ++i) row[static_cast<int>(i)] = norms[i] * values[i];
    products += row * row.transpose() / static_cast<double>(directions.size());
  }
  EXPECT_LT((products - Eigen::MatrixXd::Identity(products.rows(), products.cols())).cwiseAbs().maxCoeff(), 1e-3);
}

// Along the sphere, where the harmonics are evaluated: a derivative's tangential part is that of the values.
TEST(SolidHarmonics, DerivativesAgreeWithDifferences) {
  constexpr int degree = 7;
  int cases = 0;
  for (std::size_t i = 0; i < harmonic_count(degree); ++i) {
    std::vector<double> coefficients(harmonic_count(degree), 0.0);
    coefficients[i] = harmonic_norms(degree)[i];
    for (const Vec3& d : even_directions(7)) {
      Vec3 gradient;
      for (int axis = 0; axis < 3; ++axis)
        gradient[axis] = value(harmonic_derivative(coefficients, degree, axis), degree, d);
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 t = d.cross(Vec3::Unit(axis)).normalized();
        constexpr double h = 1e-5;
        const double slope = (value(coefficients, degree, (d + h * t).normalized()) -
                              value(coefficients, degree, (d - h * t).normalized())) /
                             (2 * h);
        EXPECT_NEAR(gradient.dot(t), slope, 1e-6) << "harmonic " << i;
        ++cases;
      }
      // A solid harmonic is homogeneous: x . grad R_l = l R_l.
      const int l = static_cast<int>(std::sqrt(static_cast<double>(i)));
      EXPECT_NEAR(gradient.dot(d), l * value(coefficients, degree, d), 1e-9) << "harmonic " << i;
    }
  }
  EXPECT_EQ(cases, 64 * 7 * 3);
}

}  // namespace
}  // namespace plica
