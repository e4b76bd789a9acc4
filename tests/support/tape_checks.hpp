// Comparison of gradients of recorded runs with central differences over the same steps.
#pragma once

#include "simulation/tape.hpp"
#include "support/scenarios.hpp"
#include "support/tissues.hpp"

namespace plica::support {

struct TapeKey {
  std::string name;
  double value;
};

// An outcome of all positions at one time: J = sum w.x + |x - X|^2/200, with random w and X at rest.
struct TapeOutcome {
  Vectors weights;
  const Tissue& tissue;
  double of(const Vectors& x, Vectors* gradient = nullptr) const {
    double sum = 0;
    if (gradient != nullptr) *gradient = weights;
    for (std::size_t n = 0; n < x.size(); ++n) {
      const Vec3 moved = x[n] - tissue.rest_positions[n];
      sum += weights[n].dot(moved) + moved.squaredNorm() / 200;
      if (gradient != nullptr) (*gradient)[n] += moved / 100;
    }
    return sum;
  }
};

struct TapeCase {
  ScenarioSource source;
  std::vector<std::string> overrides;
  std::vector<TapeKey> keys;
  std::string law;  // with a field of strengths
  double until_s;
  std::vector<double> at_s = {};  // further times that the outcome looks at
  double tolerance = 1e-7;
  double first_h = 1e-3;
  double between_ways = 1e-8;  // relative difference of tangents and way back
};

// Compares with differences at several h, of which the best counts: larger ones have their own error, smaller ones the
// solver's.
inline void expect_gradient(const TapeCase& c, std::size_t least_changes = 0) {
  constexpr int most_of_sweep = 3;
  const Scenario scenario = load_scenario(c.source, c.overrides);
  const Tape recorded(scenario, {.at_s = c.at_s, .until_s = c.until_s});
  const Tape tape = recorded.replayed(scenario, {});
  ASSERT_GE(tape.steps(), 3u);
  ASSERT_GE(tape.changes(), least_changes);
  std::vector<std::size_t> states = {tape.steps()};
  for (const double time_s : c.at_s) states.push_back(tape.state_at(time_s));

  Random random(7);
  std::map<std::size_t, TapeOutcome> outcomes;
  OutcomeGradient by_positions;
  for (const std::size_t state : states) {
    const Tissue& tissue = tape.tissue(state);
    const auto weights = Random(7).vectors(tissue.node_count());
    outcomes.emplace(state, TapeOutcome{weights, tissue}).first->second.of(tape.positions(state), &by_positions[state]);
  }
  const auto value = [&](const Tape& of) {
    double sum = 0;
    for (const auto& [state, outcome] : outcomes) sum += outcome.of(of.positions(state));
    return sum;
  };

  const auto with = [&](const TapeKey& key, double by) {
    std::vector<std::string> overrides = c.overrides;
    overrides.push_back(fmt::format("{}={:.17g}", key.name, key.value * (1 + by)));
    return load_scenario(c.source, overrides);
  };
  std::vector<ModelPair> pairs;
  for (const TapeKey& key : c.keys)
    pairs.push_back(tape.parameter(key.name, with(key, 1e-4), with(key, -1e-4), 2e-4 * key.value));
  Tape::Wanted wanted{.law = c.law, .tolerance = 1e-11};
  for (const ModelPair& pair : pairs) wanted.parameters.push_back(&pair);
  const auto gradient = tape.gradient(by_positions, wanted);
  ASSERT_TRUE(gradient);

  // Small derivatives drown in the rounding of the outcome.
  double floor = 0;
  for (std::size_t k = 0; k < c.keys.size(); ++k)
    floor = std::max(floor, 0.03 * std::abs(gradient->by_parameter[k] * c.keys[k].value));

  TangentInput tangent_input{.tolerance = 1e-11};
  tangent_input.parameters = wanted.parameters;
  const auto jacobian = tape.jacobian({by_positions, {}}, tangent_input);
  ASSERT_TRUE(jacobian && jacobian->size() == 2);
  EXPECT_EQ(jacobian->back(), std::vector<double>(c.keys.size(), 0.0));
  for (std::size_t k = 0; k < c.keys.size(); ++k) {
    const double by_way_back = gradient->by_parameter[k], by_tangent = jacobian->front()[k];
    const double error = std::abs(by_tangent - by_way_back) / (std::abs(by_way_back) + floor / c.keys[k].value);
    EXPECT_LE(error, c.between_ways) << c.keys[k].name << ": " << by_tangent << ", " << by_way_back;
    fmt::print("{:44} tangent and way back differ by {:.1e}\n", c.keys[k].name, error);
  }

  const auto expect_as_differences = [&](const std::string& name, double by_way_back, const auto& changed) {
    double best = std::numeric_limits<double>::infinity();
    std::string all;
    double h = c.first_h;
    for (int k = 0; k < most_of_sweep && best > c.tolerance / 10; ++k, h /= 10) {
      const double difference = (value(changed(h)) - value(changed(-h))) / (2 * h);
      const double error = std::abs(by_way_back - difference) / (std::abs(difference) + floor);
      all += fmt::format(" h {:.0e}: {:.2e}", h, error);
      best = std::min(best, error);
    }
    EXPECT_LE(best, c.tolerance) << name << ": " << by_way_back << all;
    fmt::print("{:44} {: .6e}{}\n", name, by_way_back, all);
  };
  for (std::size_t k = 0; k < c.keys.size(); ++k)
    expect_as_differences(c.keys[k].name, gradient->by_parameter[k] * c.keys[k].value,
                          [&](double h) { return tape.replayed(with(c.keys[k], h), {}); });
  if (c.law.empty()) return;
  // The field: along a random direction, and for the cell with the largest derivative.
  const std::vector<double>& by_strength = gradient->by_strength;
  ASSERT_EQ(by_strength.size(), tape.tissue().cells.size());
  std::vector<double> direction(by_strength.size());
  for (double& d : direction) d = random.number();
  const auto along = [&] { return std::inner_product(direction.begin(), direction.end(), by_strength.begin(), 0.0); };
  const auto scaled = [&](double h) {
    std::vector<double> factors(direction.size());
    for (std::size_t i = 0; i < factors.size(); ++i) factors[i] = 1 + h * direction[i];
    return tape.replayed(scenario, {{c.law, factors}});
  };
  if (!c.overrides.empty() && c.overrides.back().find("mirror") != std::string::npos)
    direction.assign(direction.size(), 1);
  expect_as_differences("all cells", along(), scaled);
  const auto moved = tape.tangent({{c.law, direction}}, states, {.tolerance = 1e-11});
  ASSERT_TRUE(moved && moved->size() == states.size());
  double by_tangent = 0;
  for (std::size_t k = 0; k < states.size(); ++k)
    for (std::size_t n = 0; n < (*moved)[k].size(); ++n) by_tangent += by_positions[states[k]][n].dot((*moved)[k][n]);
  const auto size = [](double a, double b) { return std::abs(a) < std::abs(b); };
  // Derivatives by cells cancel in the sum, errors of solves do not.
  const double largest_term = std::abs(*std::ranges::max_element(by_strength, size));
  const double error = std::abs(by_tangent - along()) / (std::max(std::abs(along()), largest_term) + floor);
  EXPECT_LE(error, c.between_ways) << "all cells: " << by_tangent << ", " << along();
  fmt::print("{:44} tangent and way back differ by {:.1e}\n", "all cells", error);
  if (direction.front() == direction.back()) return;
  const auto largest = std::ranges::max_element(by_strength, size) - by_strength.begin();
  std::ranges::fill(direction, 0);
  direction[static_cast<std::size_t>(largest)] = 1;
  expect_as_differences("one cell", along(), scaled);
}

}  // namespace plica::support
