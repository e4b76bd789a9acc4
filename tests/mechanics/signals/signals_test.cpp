// Signals: what is made, decays, diffuses and reacts, against solutions of these equations.
#include "mechanics/signals/signals.hpp"

#include <complex>
#include <numbers>

#include "scenario/setup.hpp"
#include "support/scenarios.hpp"
#include "support/tissues.hpp"
#include "tissue/division.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace {

Tissue sheet_of(double length, double width, int cells, const std::string& more = "") {
  return make_tissue(scenario_of("format = 1\n" + sheet_table(length, width, 10, cells) + more));
}

const std::string both_periods = "periodic = [\"x\", \"y\"]\n";

SignalRule rule_of(const Tissue& tissue, const std::string& name = "u") {
  SignalRule rule;
  rule.name = name;
  rule.initial = rule.sources = CellArray(tissue.cells.size(), 0.0);
  return rule;
}

std::vector<double> volumes_of(const Tissue& tissue, const Vectors& positions) {
  return CellVolumes(tissue).volumes(positions);
}

double total(std::span<const double> volumes, std::span<const double> concentrations) {
  double sum = 0;
  for (std::size_t c = 0; c < volumes.size(); ++c) sum += volumes[c] * concentrations[c];
  return sum;
}

// A step of two signals that diffuse and react, with the area of cells too, in a tissue that moves: gradients by
// concentrations, volumes and positions.
TEST(Signals, DerivativesOfAStepAgreeWithFiniteDifferences) {
  const Tissue tissue = sheet_of(40, 40, 20, both_periods);
  SignalRule u = rule_of(tissue, "u"), v = rule_of(tissue, "v");
  u.diffusion = 0.5, u.decay = 0.01, u.reaction = "k * u * (1 - u) * apical_area_ratio - v", u.constants = {{"k", 6}};
  v.reaction = "2 * u - v * height_ratio";
  for (double& source : u.sources) source = 0.02;
  const Signals signals(tissue, {u, v});
  Random random(8);
  Signals::Values values = signals.initial(), of_after = values, d_values = values;
  for (Signals::Values* all : {&values, &of_after, &d_values})
    for (CellArray& array : *all)
      for (double& c : array) c = all == &values ? 0.5 + random.number(0.4) : random.number();
  Vectors x = tissue.rest_positions, dx = random.vectors(x.size());
  for (Vec3& place : x) place += random.vector(0.3);
  std::vector<double> before = volumes_of(tissue, tissue.rest_positions), after = volumes_of(tissue, x);
  std::vector<double> d_before(before.size()), d_after = d_before;
  for (std::vector<double>* all : {&d_before, &d_after})
    for (double& volume : *all) volume = random.number(10);

  constexpr double duration_s = 8;
  Vectors by_positions(x.size(), Vec3::Zero());
  Signals::GeometryGradient by{std::vector<double>(before.size(), 0.0), std::vector<double>(before.size(), 0.0),
                               by_positions};
  const Signals::Values by_values = signals.pull_back(tissue, {before, after, x}, duration_s, values, of_after, by);
  const auto outcome = [&](double h) {
    Signals::Values at = values;
    Vectors there = x;
    std::vector<double> then = before, now = after;
    for (std::size_t s = 0; s < at.size(); ++s)
      for (std::size_t c = 0; c < at[s].size(); ++c) at[s][c] += h * d_values[s][c];
    for (std::size_t n = 0; n < x.size(); ++n) there[n] += h * dx[n];
    for (std::size_t c = 0; c < then.size(); ++c) then[c] += h * d_before[c], now[c] += h * d_after[c];
    EXPECT_FALSE(signals.advance(tissue, {then, now, there}, duration_s, at));
    double sum = 0;
    for (std::size_t s = 0; s < at.size(); ++s)
      for (std::size_t c = 0; c < at[s].size(); ++c) sum += of_after[s][c] * at[s][c];
    return sum;
  };
  double along = dot(by_positions, dx);
  for (std::size_t c = 0; c < before.size(); ++c)
    along += by.volumes_before[c] * d_before[c] + by.volumes[c] * d_after[c] + by_values[0][c] * d_values[0][c] +
             by_values[1][c] * d_values[1][c];
  EXPECT_NEAR(along, (outcome(1e-4) - outcome(-1e-4)) / 2e-4, 1e-7 * std::abs(along));
}

// Advances signals of a tissue that does not move.
void advance_still(const Signals& signals, const Tissue& tissue, double duration_s, int steps,
                   Signals::Values& values) {
  const std::vector<double> volumes = volumes_of(tissue, tissue.rest_positions);
  for (int i = 0; i < steps; ++i) {
    const auto failure = signals.advance(tissue, {volumes, volumes, tissue.rest_positions}, duration_s / steps, values);
    ASSERT_FALSE(failure) << failure->problem;
  }
}

TEST(Signals, AreConservedWhileTheyDiffuseAndCellsMove) {
  double worst = 0;
  for (const double diffusion : {0.01, 3.0, 1e4})
    for (const std::string& more : {std::string(), both_periods}) {
      const Tissue tissue = sheet_of(60, 50, 60, more);
      SignalRule rule = rule_of(tissue);
      rule.diffusion = diffusion;
      Random random(7);
      for (double& c : rule.initial) c = std::max(0.0, random.number(100));
      const Signals signals(tissue, {rule});
      Signals::Values values = signals.initial();
      Vectors x = tissue.rest_positions;
      std::vector<double> volumes = volumes_of(tissue, x);
      const double before = total(volumes, values[0]);
      for (int step = 0; step < 200; ++step) {
        Vectors next = x;
        for (std::size_t n = 0; n < tissue.free_node_count(); ++n)
          next[n] = tissue.rest_positions[n] + random.vector(0.3);
        tissue.place_hanging_positions(next);
        const std::vector<double> after = volumes_of(tissue, next);
        ASSERT_FALSE(signals.advance(tissue, {volumes, after, next}, 10, values));
        EXPECT_GE(*std::ranges::min_element(values[0]), 0);
        volumes = after, x = next;
        worst = std::max(worst, std::abs(total(volumes, values[0]) / before - 1));
      }
    }
  EXPECT_LE(worst, 1e-12);
  std::cout << "amounts over 200 steps: off by " << worst << "\n";
}

TEST(Signals, DecayAndSourcesAreExactForAnyStep) {
  const Tissue tissue = sheet_of(30, 30, 12);
  SignalRule rule = rule_of(tissue);
  rule.decay = 0.02, rule.diffusion = 5;
  rule.initial = CellArray(tissue.cells.size(), 3.0), rule.sources = CellArray(tissue.cells.size(), 0.1);
  const Signals signals(tissue, {rule});
  for (const int steps : {1, 7, 100}) {
    Signals::Values values = signals.initial();
    advance_still(signals, tissue, 90, steps, values);
    const double faded = std::exp(-0.02 * 90);
    for (const double c : values[0]) EXPECT_NEAR(c, 3 * faded + 5 * (1 - faded), 1e-12);
  }
}

// Two cubes of 20 x 20 x 40 um, 20 um apart.
TEST(Signals, TwoCellsExchangeByTheirFaceOverTheirDistance) {
  const Tissue tissue = build_block(two_cells);
  SignalRule rule = rule_of(tissue);
  rule.diffusion = 0.3, rule.initial = {8, 2};
  const Signals signals(tissue, {rule});
  Signals::Values values = signals.initial();
  advance_still(signals, tissue, 600, 100, values);
  const double rate = 2 * 0.3 * (20 * 40 / 20.0) / (20 * 20 * 40);
  EXPECT_NEAR(values[0][0] - values[0][1], 6 * std::pow(1 + 6 * rate, -100), 1e-12);
  EXPECT_NEAR(values[0][0] - values[0][1], 6 * std::exp(-rate * 600), 0.03);
  EXPECT_NEAR(values[0][0] + values[0][1], 10, 1e-12);
}

// A point source on a periodic sheet spreads as the heat kernel, summed over its images.
TEST(Signals, APointSpreadsAsGreensFunctionOnAPeriodicSheet) {
  constexpr double length = 160, width = 160, height = 10, diffusion = 0.5, time_s = 600;
  const Tissue tissue = sheet_of(length, width, 1600, both_periods);
  const std::vector<double> volumes = volumes_of(tissue, tissue.rest_positions);
  SignalRule rule = rule_of(tissue);
  rule.diffusion = diffusion;
  rule.initial[800] = 1 / volumes[800];
  const Signals signals(tissue, {rule});
  Signals::Values values = signals.initial();
  advance_still(signals, tissue, time_s, 200, values);
  const Vec3 source = cell_centre(tissue.cells[800], tissue.rest_positions);
  double square = 0, squares = 0, largest_error = 0, peak = 0;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Vec3 apart = cell_centre(tissue.cells[c], tissue.rest_positions) - source;
    double exact = 0;
    for (int i = -3; i <= 3; ++i)
      for (int j = -3; j <= 3; ++j) {
        const double x = apart.x() + i * length, y = apart.y() + j * width;
        exact += std::exp(-(x * x + y * y) / (4 * diffusion * time_s)) /
                 (4 * std::numbers::pi * diffusion * time_s * height);
      }
    square += (values[0][c] - exact) * (values[0][c] - exact), squares += exact * exact;
    largest_error = std::max(largest_error, std::abs(values[0][c] - exact)), peak = std::max(peak, exact);
  }
  EXPECT_LE(std::sqrt(square / squares), 0.02);
  EXPECT_LE(largest_error / peak, 0.02);
  std::cout << "Green's function: off by " << std::sqrt(square / squares) << " (root mean square), "
            << largest_error / peak << " of the peak\n";
}

TEST(Signals, LogisticGrowthEndsWhereItsReactionDoes) {
  const Tissue tissue = sheet_of(30, 30, 12);
  SignalRule rule = rule_of(tissue);
  rule.initial = CellArray(tissue.cells.size(), 0.1);
  rule.reaction = "k * u * (1 - u / K)", rule.constants = {{"k", 2}, {"K", 3}};
  const Signals signals(tissue, {rule});
  for (const int steps : {1, 20}) {
    Signals::Values values = signals.initial();
    advance_still(signals, tissue, 120, steps, values);
    const double exact = 3 / (1 + 29 * std::exp(-2 * 2.0));
    EXPECT_NEAR(values[0][0], exact, 0.04 * exact);
    advance_still(signals, tissue, 1200, steps, values);
    EXPECT_NEAR(values[0][0], 3, 1e-9);
  }
}

// A signal is made by stretched cells, and one signal by another.
TEST(Signals, ReactionsReadMeasuresAndOtherSignals) {
  const Tissue tissue = sheet_of(30, 30, 12);
  SignalRule made = rule_of(tissue, "u"), read = rule_of(tissue, "v");
  made.reaction = "max(0, apical_area_ratio - 1)", read.reaction = "2 * u";
  const Signals signals(tissue, {made, read});
  Vectors x = tissue.rest_positions;
  for (Vec3& at : x) at.x() *= 1.5;
  const std::vector<double> volumes = volumes_of(tissue, x);
  Signals::Values values = signals.initial();
  for (int i = 0; i < 200; ++i) ASSERT_FALSE(signals.advance(tissue, {volumes, volumes, x}, 0.6, values));
  for (const double u : values[0]) EXPECT_NEAR(u, 0.5 * 2, 1e-12);
  for (const double v : values[1]) EXPECT_NEAR(v, 2.0, 0.02);
}

// Hexagons of width `a`, in rows along x.
Tissue hexagons(int columns, int rows, double a) {
  const double length = columns * a, width = rows * a * std::sqrt(3) / 2;
  Vectors points;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i)
      points.emplace_back((i + 0.25 + 0.5 * (j % 2)) * a - length / 2, (j + 0.5) * width / rows - width / 2, 0);
  return build_sheet({.length_um = length, .width_um = width, .is_periodic = {true, true}}, points, {.height_um = 10});
}

// Schnakenberg's reaction about its stationary state, u = 1, v = 0.9: growth rate of a wave of wavenumber k, 1/min.
double turing_rate(double k, double diffusion_u, double diffusion_v) {
  const double uu = 0.8 - diffusion_u * k * k, uv = 1, vu = -1.8, vv = -1 - diffusion_v * k * k;
  const double mean = (uu + vv) / 2, square = mean * mean - (uu * vv - uv * vu);
  return mean + std::sqrt(std::max(0.0, square));
}

// Of all waves in a small disturbance of one cell, that of Turing's wavelength grows fastest.
TEST(Signals, APatternHasTuringsWavelength) {
  constexpr int columns = 240;
  constexpr double a = 4, length = columns * a, diffusion_u = 20, diffusion_v = 400;
  const Tissue tissue = hexagons(columns, 4, a);
  SignalRule u = rule_of(tissue, "u"), v = rule_of(tissue, "v");
  u.diffusion = diffusion_u / 60, v.diffusion = diffusion_v / 60, u.decay = 1.0 / 60;
  u.reaction = "a + u^2 * v", u.constants = {{"a", 0.1}};
  v.reaction = "b - u^2 * v", v.constants = {{"b", 0.9}};
  u.initial = CellArray(tissue.cells.size(), 1.0), v.initial = CellArray(tissue.cells.size(), 0.9);
  u.initial[100] += 1e-3;
  const Signals signals(tissue, {u, v});
  Signals::Values values = signals.initial();
  advance_still(signals, tissue, 30 * 60, 180, values);

  // Logarithms of the power of waves along x, by their number in the length.
  std::vector<double> power(columns / 2);
  for (std::size_t n = 1; n < power.size(); ++n) {
    std::complex<double> sum = 0;
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      sum += (values[0][c] - 1) * std::polar(1.0, 2 * std::numbers::pi * static_cast<double>(n) *
                                                      cell_centre(tissue.cells[c], tissue.rest_positions).x() / length);
    power[n] = std::log(std::norm(sum));
  }
  const auto top = static_cast<std::size_t>(std::max_element(power.begin() + 1, power.end()) - power.begin());
  const double below = power[top] - power[top - 1], above = power[top] - power[top + 1];
  const double waves = static_cast<double>(top) + (below - above) / (2 * (below + above));  // of a parabola

  double fastest = 0.01;
  for (double k = 0.01; k < 1; k += 1e-4)
    if (turing_rate(k, diffusion_u, diffusion_v) > turing_rate(fastest, diffusion_u, diffusion_v)) fastest = k;
  const double wavelength = length / waves, expected = 2 * std::numbers::pi / fastest;
  EXPECT_NEAR(wavelength, expected, 0.02 * expected);
  EXPECT_GT(*std::ranges::max_element(values[0]), 1.001);
  std::cout << "Turing's wavelength " << wavelength << " um, expected " << expected << " um\n";
}

TEST(Signals, SayWhereAReactionHasNoValueAndIsTooFast) {
  const Tissue tissue = sheet_of(30, 30, 12);
  const std::vector<double> volumes = volumes_of(tissue, tissue.rest_positions);
  SignalRule rule = rule_of(tissue);
  rule.initial = CellArray(tissue.cells.size(), 1.0), rule.initial[5] = 0;
  const auto failure_of = [&](const std::string& reaction) {
    rule.reaction = reaction;
    Signals::Values values = {rule.initial};
    const auto failure = Signals(tissue, {rule}).advance(tissue, {volumes, volumes, tissue.rest_positions}, 1, values);
    EXPECT_EQ(values[0], rule.initial);
    return failure ? fmt::format("{} in {}; {}", failure->problem, failure->cell.number(), failure->remedy) : "";
  };
  EXPECT_EQ(failure_of("1 / u"), "the reaction of signal u is not finite in 5; change signal.u.reaction");
  EXPECT_EQ(failure_of("-1e9 * u^2"),
            "the reactions of signals are faster than 1024 parts of a step of 1 s resolve in 0; reduce their rates, or "
            "time.max_step_s");
  rule.sources[0] = 1e308;
  EXPECT_EQ(failure_of(""), "signal u is not finite in 0; reduce its sources, or change signal.u.reaction");
}

TEST(Signals, DaughtersKeepConcentrationsAndAmounts) {
  Tissue tissue = sheet_of(60, 50, 40);
  SignalRule rule = rule_of(tissue);
  Random random(3);
  for (double& c : rule.initial) c = 2 + random.number();
  const Signals before(tissue, {rule});
  Vectors x = tissue.rest_positions;  // bent, so that a cut changes volumes
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) x[n] += random.vector(0.5);
  tissue.place_hanging_positions(x);
  const std::vector<double> volumes = volumes_of(tissue, x);
  const TissueChange change = divide(tissue, std::array<CellCut, 2>{{{CellId(3), 0}, {CellId(17), 1}}}, 0, x);
  x = with_new_nodes(tissue, change, x);
  const std::vector<double> after = volumes_of(tissue, x);
  const Signals::Values values = inherited_signals(change, volumes, after, before.initial());
  ASSERT_EQ(values[0].size(), 42u);
  EXPECT_EQ(values[0][3], values[0][40]);
  EXPECT_NEAR(values[0][3], rule.initial[3], 0.02 * rule.initial[3]);
  EXPECT_NEAR(total(after, values[0]), total(volumes, rule.initial), 1e-12 * total(volumes, rule.initial));
  EXPECT_EQ(before.after(tissue, change).rules()[0].sources.size(), 42u);
}

}  // namespace
