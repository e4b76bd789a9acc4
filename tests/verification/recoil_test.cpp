// A line of cells is cut across and along the fibres of a tense flat sheet. Where cells keep their elasticity, a cut
// only removes the tension N = (N_x, N_y) of the patch P that it covers, and the sheet moves by
//   c du/dt = div sigma(u) - div(N on P)
// with the drag c of both faces and the plane stress sigma of a sheet of height h: moduli S of stretch at a held side
// and G of shear, 2 mu h and mu h at Poisson's ratio 0, 4 mu h and mu h where cells keep their volumes. By Fourier
// series in x and y, the parts of each mode along and across its wave vector K decay at the rates S K^2/c and G K^2/c.
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"

namespace {

constexpr double size = 320, height = 4, shear = 0.5 * height, drag = 0.1;  // um, um, nN/um, nN s/um^3
constexpr double along = 2e-3, across = 0.4 * along;                        // tensions of both faces, mN/m

/// Half lengths of a cut in the middle, um.
struct Cut {
  double x, y;
};

/// One corner of the sheet: by symmetry, edges x = 0 and y = 0 of the whole do not move across themselves.
std::string cut_sheet(const Cut& cut, int cells, const std::string& volume) {
  const double end = size / 4;
  std::string text = block_table(size / 2, size / 2, height, fmt::format("{0}, {0}, 1", cells)) +
                     fmt::format(R"([elasticity]
young_modulus_Pa = 1000
poisson_ratio = 0
[volume]
method = "{}"
[dynamics]
surface_drag_Pa_s_per_um = 50
[region.line]
x_um = [{}, {}]
y_um = [{}, {}]
[ablation.cut]
region = "line"
at_s = 0
[time]
end_s = 200
tolerance_um = 1e-6
first_step_s = 1e-3
[stop]
at_equilibrium = false
)",
                                 volume, -end, cut.x - end, -end, cut.y - end);
  for (const char* face : {"apical", "basal"})
    text += fmt::format(R"([cortex.{0}]
region = "all"
faces = "{0}"
tension_mN_per_m = {1}
direction = {{ axis = "along", weakest = {2} }}
)",
                        face, along / 2, across / along);
  for (const char* axis : {"x", "y"})
    for (const double at : {-end, end})
      text += fmt::format("[hold.{0}{1}]\nregion = \"all\"\ndirections = [\"{0}\"]\n{0}_um = [{2}, {3}]\n", axis,
                          at < 0 ? "-low" : "-high", at - 1, at + 1);
  return text;
}

/// How far the middle of the long side of a cut has moved at some times, um, and its speed in the first step, um/s.
struct Recoil {
  std::vector<double> moved;
  double first_speed = 0;
};
constexpr std::array times = {4.0, 16.0, 200.0};  // s

Recoil recoil(const Cut& cut, int cells, const std::string& volume) {
  Simulation simulation(scenario_of(cut_sheet(cut, cells, volume)));
  const Vectors& rest = simulation.model().tissue.rest_positions;
  const bool is_across = cut.x < cut.y;
  const Vec3 side(is_across ? cut.x : 0, is_across ? 0 : cut.y, height / 2);
  const Vec3 corner(size / 4, size / 4, 0);
  const auto node = std::ranges::min_element(rest, {}, [&](const Vec3& X) { return (X + corner - side).norm(); });
  const auto moved = [&] {
    return (simulation.state().positions[std::size_t(node - rest.begin())] - *node)[is_across ? 0 : 1];
  };
  Recoil found;
  EXPECT_TRUE(simulation.step()) << simulation.failure();
  found.first_speed = moved() / simulation.time_s();
  for (const double time : times) {
    simulation.run_until(time);
    EXPECT_EQ(simulation.time_s(), time) << simulation.failure();
    found.moved.push_back(moved());
  }
  return found;
}

/// The same by a series of `modes` squared terms. Its error is inversely proportional to `modes`.
double series(const Cut& cut, double stretch, double time, int modes) {
  const bool is_across = cut.x < cut.y;
  const auto wave = [](int n) { return 2 * std::numbers::pi * n / size; };
  const auto part = [&](int n, double half) {
    return n == 0 ? 2 * half / size : 4 / size * std::sin(wave(n) * half) / wave(n);
  };
  std::vector<double> by_x, by_y;
  for (int n = 0; n < modes; ++n) by_x.push_back(part(n, cut.x)), by_y.push_back(part(n, cut.y));
  const auto response = [&](double modulus, double square) {
    return -std::expm1(-modulus * square * time / drag) / (modulus * square);
  };
  double sum = 0;
  for (int n = 0; n < modes; ++n)
    for (int m = n == 0; m < modes; ++m) {
      const double k = wave(n), q = wave(m), square = k * k + q * q;
      const double force_x = along * k * by_x[n] * by_y[m], force_y = across * q * by_x[n] * by_y[m];
      const double parallel = (force_x * k + force_y * q) / square * response(stretch, square);
      const double normal = (force_y * k - force_x * q) / square * response(shear, square);
      sum += is_across ? (k * parallel - q * normal) * std::sin(k * cut.x)
                       : (q * parallel + k * normal) * std::sin(q * cut.y);
    }
  return sum;
}
double predicted(const Cut& cut, double stretch, double time) {
  return 2 * series(cut, stretch, time, 800) - series(cut, stretch, time, 400);
}

constexpr Cut across_fibres = {20, 60}, along_fibres = {60, 20};

TEST(Recoil, OfACutAcrossAndAlongFibresIsThatOfAPlaneElasticSheet) {
  const Recoil at_right_angles = recoil(across_fibres, 32, "none"), parallel = recoil(along_fibres, 32, "none");
  // At first only drag resists: the tension on one side of a node over the drag of the node.
  EXPECT_NEAR(at_right_angles.first_speed / (along / (drag * size / 64)), 1, 0.01);
  EXPECT_NEAR(parallel.first_speed / at_right_angles.first_speed, across / along, 1e-3);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double opened = predicted(across_fibres, 2 * shear, times[i]);
    const double opened_along = predicted(along_fibres, 2 * shear, times[i]);
    std::printf("%5.0f s: across fibres %.3e (%+.2f %%), along them %.3e (%+.2f %%), ratio %.3f\n", times[i], opened,
                100 * (at_right_angles.moved[i] / opened - 1), opened_along,
                100 * (parallel.moved[i] / opened_along - 1), parallel.moved[i] / at_right_angles.moved[i]);
    EXPECT_NEAR(at_right_angles.moved[i] / opened, 1, i == 0 ? 0.015 : 0.005);
    EXPECT_NEAR(parallel.moved[i] / opened_along, 1, i == 0 ? 0.015 : 0.005);
  }
}

// The height of a cell steps at the cut, that of nodes cannot: the error is about proportional to the size of cells.
TEST(Recoil, OfCellsThatKeepTheirVolumeIsThatOfAnIncompressibleSheet) {
  for (const Cut& cut : {across_fibres, along_fibres}) {
    const Recoil coarse = recoil(cut, 16, "coupled"), fine = recoil(cut, 32, "coupled");
    for (std::size_t i = 1; i < times.size(); ++i) {
      const double opened = predicted(cut, 4 * shear, times[i]), found = 2 * fine.moved[i] - coarse.moved[i];
      std::printf("%5.0f s: %.3e (%+.1f, %+.1f, extrapolated %+.2f %%)\n", times[i], opened,
                  100 * (coarse.moved[i] / opened - 1), 100 * (fine.moved[i] / opened - 1), 100 * (found / opened - 1));
      EXPECT_NEAR(found / opened, 1, 0.02);
    }
  }
}

}  // namespace
