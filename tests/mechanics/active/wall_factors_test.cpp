// Factors on the tension of lateral faces: direction and noise.
#include "mechanics/active/wall_factors.hpp"

#include "mechanics/active/cortex.hpp"
#include "support/law_checks.hpp"
#include "support/tissues.hpp"

namespace {

const WallNoise noise{.spread = 0.5, .correlation_s = 120, .seed = 7};

// A face 10 um high, whose normal makes an angle with x; turned about y.
std::array<Vec3, 4> face_at(double angle, double tilt = 0) {
  const Vec3 along(-std::sin(angle), std::cos(angle), 0), up(0, 0, 10);
  std::array<Vec3, 4> face = {Vec3::Zero(), along, along + up, up};
  const Mat3 turn = Eigen::AngleAxisd(tilt, Vec3::UnitY()).toRotationMatrix();
  for (Vec3& x : face) x = turn * x;
  return face;
}

TEST(WallFactors, GoByTheAngleOfTheNormal) {
  const WallDirection along{.strongest = 1.6, .weakest = 0.4}, across{true, 1.6, 0.4};
  for (const double angle : {0.0, 0.3, 1.0, 1.5707963267948966, 2.0}) {
    EXPECT_NEAR(direction_factor(along, face_at(angle)), 1 + 0.6 * std::cos(2 * angle), 1e-12);
    EXPECT_NEAR(direction_factor(across, face_at(angle)), 1 - 0.6 * std::cos(2 * angle), 1e-12);
    // The axis lies in the surface, wherever that goes.
    EXPECT_NEAR(direction_factor(along, face_at(angle, 0.8)), 1 + 0.6 * std::cos(2 * angle), 1e-12);
  }
  EXPECT_NEAR(direction_factor(along, face_at(0.3, std::numbers::pi / 2)), 1, 1e-12);  // x leaves the surface
}

TEST(WallFactors, OfADirectionHaveTheGradientOfDifferences) {
  const WallDirection along{.strongest = 1.6, .weakest = 0.4};
  Random random(3);
  for (int k = 0; k < 5; ++k) {
    std::array<Vec3, 4> face = face_at(random.number(3), random.number(1));
    for (Vec3& x : face) x += random.vector(0.1);
    const std::array<Vec3, 4> gradient = direction_gradient(along, face);
    for (std::size_t i = 0; i < 4; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        std::array<Vec3, 4> more = face, less = face;
        more[i][axis] += 1e-5, less[i][axis] -= 1e-5;
        EXPECT_NEAR(gradient[i][axis], (direction_factor(along, more) - direction_factor(along, less)) / 2e-5, 1e-7);
      }
  }
}

TEST(WallFactors, OfNoiseHaveMeanSpreadAndCorrelation) {
  constexpr int pairs = 20000;
  const double variance = std::log1p(noise.spread * noise.spread);
  for (const double time_s : {0.0, 17.0, 1000.0}) {
    double mean = 0, squares = 0;
    std::map<double, double> products;
    for (int pair = 0; pair < pairs; ++pair) {
      const double one = noise_factor(noise, pair_number(pair, pair + 1), time_s);
      mean += one / pairs;
      squares += one * one / pairs;
      for (const double later_s : {60.0, 120.0, 240.0}) {
        const auto normal = [&](double at_s) {
          return (std::log(noise_factor(noise, pair_number(pair, pair + 1), at_s)) + 0.5 * variance) /
                 std::sqrt(variance);
        };
        products[later_s] += normal(time_s) * normal(time_s + later_s) / pairs;
      }
    }
    EXPECT_NEAR(mean, 1, 0.02);
    EXPECT_NEAR(std::sqrt(squares - mean * mean), noise.spread, 0.03);
    for (const auto& [later_s, correlation] : products) EXPECT_NEAR(correlation, std::exp(-later_s / 120), 0.03);
  }
}

TEST(WallFactors, OfNoiseAreContinuousAndIndependent) {
  double largest = 0, product = 0;
  for (int pair = 0; pair < 2000; ++pair) {
    const std::uint64_t number = pair_number(3, pair);
    for (const double time_s : {30.0, 60.0, 90.0})  // where its white noise changes
      largest = std::max(largest, std::abs(std::log(noise_factor(noise, number, time_s + 1e-6)) -
                                           std::log(noise_factor(noise, number, time_s - 1e-6))));
    product +=
        std::log(noise_factor(noise, number, 50)) * std::log(noise_factor(noise, pair_number(4, pair), 50)) / 2000;
  }
  EXPECT_LT(largest, 1e-5);
  EXPECT_NEAR(product, std::pow(0.5 * std::log1p(0.25), 2), 0.03);
  EXPECT_NE(noise_factor(noise, 1, 50), noise_factor({.spread = 0.5, .correlation_s = 120, .seed = 8}, 1, 50));
}

TEST(WallFactors, OfNoiseAreTheSameForManyPairs) {
  NoiseOfPairs kept(noise);
  std::vector<std::uint64_t> pairs;
  for (int pair = 0; pair < 20; ++pair) {
    pairs.push_back(pair_number(pair, 7));
    for (const double time_s : {0.0, 3.0, 35.0, 29.0, 300.0, 301.5}) {
      kept.go_to(time_s, pairs);
      for (const std::uint64_t one : pairs) EXPECT_EQ(kept.factor(one), noise_factor(noise, one, time_s));
    }
  }
}

// Walls of a block are normal to an axis: tensions, and forces on a corner, are those of two walls.
TEST(WallFactors, PullByTheDirectionOfEveryWallOfABlock) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}});
  const Motion motion = at_rest(tissue);
  for (const bool across : {false, true}) {
    const Cortex law(tissue, CellSet(tissue.cells.size(), true),
                     {.side = CellSide::lateral, .tension = 1, .walls = {WallDirection{across, 1.6, 0.4}, {}}});
    const std::vector<double> tensions = law.tensions(motion.step());
    ASSERT_EQ(tensions.size(), 3U * 3 + 4 * 2);
    for (std::size_t f = 0; f < tensions.size(); ++f) {
      const Vec3 normal = facet_area_vector(gather(tissue.rest_positions, law.faces()[f].nodes)).normalized();
      EXPECT_NEAR(tensions[f], std::abs(across ? normal.y() : normal.x()) > 0.5 ? 1.6 : 0.4, 1e-12);
    }
    // At a corner of the block: the wall along x pulls towards +x with half its tension times its height.
    const auto at_corner = std::ranges::find_if(tissue.rest_positions, [](const Vec3& x) { return x.x() < -29; });
    const Vec3 force =
        forces_of(law, motion.step())[static_cast<std::size_t>(at_corner - tissue.rest_positions.begin())];
    EXPECT_NEAR(std::abs(force.x()), 15 * (across ? 1.6 : 0.4), 1e-9);
  }
}

TEST(WallFactors, LeaveForcesThoseOfAnEnergy) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
  const Cortex law(tissue, CellSet(tissue.cells.size(), true),
                   {.side = CellSide::lateral,
                    .tension = 1.4,
                    .saturation = 0.16,
                    .stiffness = 0.3,
                    .walls = {WallDirection{.strongest = 1.6, .weakest = 0.4}, noise}});
  check_derivatives(law, tissue, 2);
  check_energy_flow(law, tissue);
  // What is kept of an iterate is of its step: another beginning, another time.
  const Motion one = random_motion(tissue, 2, 1);
  Motion other = one;
  other.previous_positions = random_motion(tissue, 2, 2).previous_positions;
  const Vectors forces = forces_of(law, one.step());
  EXPECT_GT(largest_distance(forces_of(law, other.step()), forces), 1e-3);
  EXPECT_EQ(forces_of(law, one.step()), forces);
  other = one;
  other.end_time_s += 50;
  EXPECT_GT(largest_distance(forces_of(law, other.step()), forces), 1e-3);
}

}  // namespace
