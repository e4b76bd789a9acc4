// A strip that grows between two walls on a Winkler foundation buckles at the wavelength 2 pi (B/K)^(1/4), with the
// bending stiffness B = E h^3/12(1 - nu^2) of plane strain (Biot 1937; Allen 1969).
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"

namespace {

constexpr double length = 800, height = 5, young = 1, poisson = 0.3;  // um, nN/um^2

std::string growing_strip(double foundation) {
  return block_table(length, 4, height, "200, 1, 1") + fmt::format(R"([elasticity]
young_modulus_Pa = 1000
poisson_ratio = {}
[dynamics]
surface_drag_Pa_s_per_um = 0.5
[foundation.ground]
region = "all"
stiffness_nN_per_um3 = {}
resists = "normal"
[growth.all]
region = "all"
rate_per_h = 0.1
in_plane = 1
axis = "across"
axis_ratio = 0
variation = {{ spread = 0.02, seed = 3 }}
[hold.plane]
region = "all"
directions = ["y"]
[hold.left]
region = "all"
directions = ["x", "z"]
x_um = [-401, -399]
[hold.right]
region = "all"
directions = ["x", "z"]
x_um = [399, 401]
[time]
end_min = 120
[stop]
at_equilibrium = false
)",
                                                                   poisson, foundation);
}

TEST(GrowthWavelength, OnAWinklerFoundationIsThatOfItsBendingStiffness) {
  for (const double foundation : {0.0004, 0.0012}) {
    const double bending = young * height * height * height / 12 / (1 - poisson * poisson);
    const double predicted = 2 * std::numbers::pi * std::pow(bending / foundation, 0.25);
    Simulation simulation(scenario_of(growing_strip(foundation)));
    const Vectors& rest = simulation.model().tissue.rest_positions;
    const auto height_of = [&](std::size_t n) { return simulation.state().positions[n].z() - rest[n].z(); };
    double largest = 0;
    while (largest < 1 && simulation.step()) {
      largest = 0;
      for (std::size_t n = 0; n < rest.size(); ++n) largest = std::max(largest, std::abs(height_of(n)));
    }
    ASSERT_GE(largest, 1) << simulation.failure();
    // Mean wave number, weighted by the squared amplitude.
    double sum = 0, weight = 0;
    for (int k = 2; k < 60; ++k) {
      double cosine = 0, sine = 0;
      for (std::size_t n = 0; n < rest.size(); ++n) {
        if (rest[n].z() > 0) continue;
        const double phase = 2 * std::numbers::pi * k * rest[n].x() / length;
        cosine += height_of(n) * std::cos(phase), sine += height_of(n) * std::sin(phase);
      }
      const double power = cosine * cosine + sine * sine;
      sum += k * power, weight += power;
    }
    const double seen = length * weight / sum;
    std::printf("K = %.4f nN/um^3: wavelength %.1f um, predicted %.1f um, at %.1f min in %d steps\n", foundation, seen,
                predicted, simulation.time_s() / 60, simulation.steps());
    EXPECT_NEAR(seen / predicted, 1, 0.05);
  }
}

}  // namespace
