// Surfaces of solid harmonics around an origin, and fits of them.
#include "tissue/shapes/star_surface.hpp"

#include "support/mesh_error.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

StarSurface ellipsoid(double a, double b, double c) { return {Mat3::Identity(), Vec3(a, b, c), {1.0}}; }

Mat3 some_rotation() { return Eigen::AngleAxisd(1.1, Vec3(1, 2, -0.5).normalized()).toRotationMatrix(); }

// The least distance to a fine net of points, refined about the nearest of them.
double searched_distance(const StarSurface& surface, const Vec3& point, const Vectors& net) {
  double best = std::numeric_limits<double>::infinity();
  Vec3 at = net.front();
  for (const Vec3& direction : net) {
    const double distance = (surface.in_direction(direction) - point).norm();
    if (distance < best) best = distance, at = direction;
  }
  for (double step = 0.05; step > 1e-9; step /= 2)
    for (int turn = 0; turn < 20; ++turn) {
      const Vec3 before = at;
      const Vec3 e1 = before.unitOrthogonal(), e2 = before.cross(e1);
      for (int k = 0; k < 8; ++k) {
        const double angle = k * std::numbers::pi / 4;
        const Vec3 trial = (before + step * (std::cos(angle) * e1 + std::sin(angle) * e2)).normalized();
        const double distance = (surface.in_direction(trial) - point).norm();
        if (distance < best) best = distance, at = trial;
      }
      if (at == before) break;
    }
  return best;
}

TEST(StarSurface, OfDegreeZeroIsASphere) {
  const StarSurface ball = ellipsoid(50, 50, 50);
  EXPECT_NEAR(ball.volume(), 4 * std::numbers::pi / 3 * 125'000, 1);
  EXPECT_NEAR(ball.area(), 4 * std::numbers::pi * 2500, 1e-3);
  EXPECT_NEAR(ball.least_radius(), 50, 1e-9);
  for (const double radius : {1.0, 25.0, 49.0, 51.0, 500.0}) {
    const Vec3 direction = Vec3(1, -2, 0.3).normalized();
    const ClosestOnSurface closest = ball.closest(radius * direction);
    EXPECT_NEAR(closest.signed_distance_um, radius - 50, 1e-9);
    EXPECT_LT((closest.normal - direction).norm(), 1e-9);
    EXPECT_LT((closest.point - 50 * direction).norm(), 1e-7);
  }
}

TEST(StarSurface, ClosestPlacesAgreeWithASearch) {
  const Vectors net = even_directions(4000);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const StarSurface& surface : {ellipsoid(250, 90, 90), egg_surface({500, 180, 180, 17, 7})})
    for (int i = 0; i < 60; ++i) {
      // From the middle of the egg to twice its size.
      const Vec3 point(500 * uniform(random), 150 * uniform(random), 150 * uniform(random));
      const ClosestOnSurface closest = surface.closest(point);
      const double distance = searched_distance(surface, point, net);
      EXPECT_NEAR(std::abs(closest.signed_distance_um), distance, 1e-6) << point.transpose();
      EXPECT_LT((closest.point + closest.signed_distance_um * closest.normal - point).norm(), 1e-6);
      EXPECT_EQ(closest.signed_distance_um < 0, point.norm() < surface.along_ray(point).norm());
    }
}

// Near the axis of a bent egg the ray's side is often not the nearest: belly, back and flanks each have a nearest
// place.
TEST(StarSurface, ClosestPlacesOfDeepPointsAreTheNearestOfSeveral) {
  const Vectors net = even_directions(4000);
  const StarSurface egg = egg_surface({500, 200, 150, 14, 7});
  for (double x = -200; x <= 200; x += 25)
    for (const double z : {-12.0, -4.0, 4.0, 12.0}) {
      const Vec3 point(x + 1, 0.5, z);
      const ClosestOnSurface closest = egg.closest(point);
      // The search itself may end at another of them.
      EXPECT_LT(-closest.signed_distance_um, searched_distance(egg, point, net) + 1e-6) << point.transpose();
      EXPECT_NEAR((closest.point - point).norm(), -closest.signed_distance_um, 1e-9);
      EXPECT_LT((egg.along_ray(closest.point) - closest.point).norm(), 1e-9);
    }
}

TEST(StarSurface, PutOnEndsNextToTheClosestPlace) {
  const StarSurface egg = egg_surface({500, 180, 180, 17, 7});
  for (const Vec3& direction : even_directions(100)) {
    const Vec3 on = egg.in_direction(direction);
    const Vec3 near = on + 0.5 * egg.bend(on).normal;
    EXPECT_LT((egg.put_on(near) - on).norm(), 5e-3);  // of 0.5
    EXPECT_LT((egg.along_ray(egg.put_on(near)) - egg.put_on(near)).norm(), 1e-10);
  }
}

TEST(StarSurface, BendsAtTheEndsOfAnEllipsoidsAxesAsKnown) {
  const double a = 250, b = 100, c = 80;
  const StarSurface surface = ellipsoid(a, b, c);
  const SurfaceBend pole = surface.bend(Vec3(3, 0, 0));
  EXPECT_NEAR(pole.radii[0], c * c / a, 1e-9);
  EXPECT_NEAR(pole.radii[1], b * b / a, 1e-9);
  EXPECT_NEAR(std::abs(pole.tangents[0].z()), 1, 1e-9);
  EXPECT_NEAR(pole.normal.x(), 1, 1e-12);
  const SurfaceBend belly = surface.bend(Vec3(0, 0, -1));
  EXPECT_NEAR(belly.radii[0], b * b / c, 1e-9);
  EXPECT_NEAR(belly.radii[1], a * a / c, 1e-9);
  EXPECT_NEAR(belly.normal.z(), -1, 1e-12);
}

TEST(StarSurface, GaussianCurvatureOfAnEggAddsUpToFourPi) {
  const StarSurface egg = egg_surface({500, 180, 170, 17, 7});
  const Vectors directions = even_directions(20'000);
  double sum = 0;
  for (const Vec3& direction : directions) {
    const SurfaceBend bend = egg.bend(egg.in_direction(direction));
    sum += egg.area_over(direction) / (bend.radii[0] * bend.radii[1]);
  }
  EXPECT_NEAR(sum / static_cast<double>(directions.size()), 1, 1e-3);
}

TEST(StarSurface, TurnsNoWayThroughTheOrigin) {
  expect_mesh_error([] { StarSurface(Mat3::Identity(), Vec3(1, 1, 1), {0.1, 1, 1, 1}); }, "origin");
}

TEST(StarFit, FindsAnEggThatIsTurned) {
  const StarSurface egg = egg_surface({500, 180, 180, 17, 7});
  Vectors points;
  for (const Vec3& direction : even_directions(2000)) points.push_back(some_rotation() * egg.in_direction(direction));
  const StarFit fit = fit_star_surface(points, 10);
  EXPECT_LT(fit.rms_um, 0.1);
  EXPECT_LT(fit.largest_um, 0.5);
  EXPECT_NEAR(fit.surface.volume(), egg.volume(), 1e-3 * egg.volume());
  const Vec3 probe(0, 0, -120);
  EXPECT_NEAR(fit.surface.closest(some_rotation() * probe).signed_distance_um, egg.closest(probe).signed_distance_um,
              0.1);
}

TEST(StarFit, FindsAnEllipsoidExactlyFromTwelvePoints) {
  Vectors points;
  for (const Vec3& direction : even_directions(12)) points.push_back(direction.cwiseProduct(Vec3(250, 90, 80)));
  const StarFit fit = fit_star_surface(points);
  EXPECT_LT(fit.largest_um, 1e-6);
  EXPECT_NEAR(fit.surface.half_axes().maxCoeff(), 250, 1e-6);
  EXPECT_NEAR(fit.surface.half_axes().minCoeff(), 80, 1e-6);
}

TEST(StarFit, TellsOfTheFarthestRow) {
  Vectors points;
  for (const Vec3& direction : even_directions(800)) points.push_back(100 * direction);
  points[300] *= 1.05;
  const StarFit fit = fit_star_surface(points);
  EXPECT_EQ(fit.largest_row, 300);
  EXPECT_NEAR(fit.largest_um, 5, 0.5);
  EXPECT_NEAR(fit.rms_um, 5 / std::sqrt(800.0), 0.05);
}

TEST(StarFit, RefusesPointsThatAreNoClosedSurface) {
  Vectors points;
  for (const Vec3& direction : even_directions(800)) points.push_back(100 * direction);
  const auto refused = [](Vectors changed, const std::string& text) {
    expect_mesh_error([&] { fit_star_surface(changed); }, text);
  };
  refused(Vectors(points.begin(), points.begin() + 11), "11 points");
  Vectors bad = points;
  bad[17].y() = std::numeric_limits<double>::quiet_NaN();
  refused(bad, "row 17");
  bad = points;
  bad[5].setZero();
  refused(bad, "row 5");
  bad = points;
  bad[300] *= 1.3;
  refused(bad, "row 300");
  bad = points;
  for (Vec3& point : bad) point.z() = std::abs(point.z());
  refused(bad, "no point lies toward");
  bad = points;
  for (Vec3& point : bad) point.z() += 300;
  refused(bad, "no point lies toward");
}

// How far the outline in y = 0 lies, in the middle, beyond its chord from 20 to 80 % of the length.
double sag(const StarSurface& egg, double half_length, int side) {
  const auto height_at = [&](double x) {
    double low = 0, high = std::numbers::pi;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (egg.along_ray(Vec3(std::cos(middle), 0, side * std::sin(middle))).x() > x ? low : high) = middle;
    }
    return std::abs(egg.along_ray(Vec3(std::cos(low), 0, side * std::sin(low))).z());
  };
  return height_at(0) - 0.5 * (height_at(0.6 * half_length) + height_at(-0.6 * half_length));
}

TEST(EggSurface, HasTheLengthsAndSagsAskedFor) {
  for (const auto& [belly, back] : {std::pair{17.0, 7.0}, {18.0, 18.0}, {10.0, 14.0}}) {
    const StarSurface egg = egg_surface({500, 180, 170, belly, back});
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    for (const Vec3& direction : even_directions(40'000)) {
      low = low.cwiseMin(egg.in_direction(direction));
      high = high.cwiseMax(egg.in_direction(direction));
    }
    EXPECT_NEAR(high.x(), 250, 0.1);
    EXPECT_NEAR(low.x(), -250, 0.1);
    EXPECT_NEAR(high.y() - low.y(), 180, 0.1);
    EXPECT_NEAR(high.z() - low.z(), 170, 0.1);
    EXPECT_NEAR(sag(egg, 250, -1), belly, 1e-6);
    EXPECT_NEAR(sag(egg, 250, 1), back, 1e-6);
  }
}

TEST(EggSurface, IsAnEllipsoidWithoutSags) {
  const StarSurface egg = egg_surface({500, 180, 160, {}, {}});
  for (const Vec3& direction : even_directions(50))
    EXPECT_NEAR(egg.in_direction(direction).cwiseQuotient(Vec3(250, 90, 80)).norm(), 1, 1e-12);
}

TEST(EggSurface, RefusesWhatIsNoEgg) {
  expect_mesh_error([] { egg_surface({500, 0, 180, {}, {}}); }, "positive");
  expect_mesh_error([] { egg_surface({500, 180, 180, 40, -20}); }, "no egg shape has sags");
}

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
      }
      // A solid harmonic is homogeneous: x . grad R_l = l R_l.
      const int l = static_cast<int>(std::sqrt(static_cast<double>(i)));
      EXPECT_NEAR(gradient.dot(d), l * value(coefficients, degree, d), 1e-9) << "harmonic " << i;
    }
  }
}

}  // namespace
