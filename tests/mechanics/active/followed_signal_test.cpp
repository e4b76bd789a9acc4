// Laws that follow a signal: growth, layers of matrix, foundations, springs, pressures.
#include "mechanics/active/followed_signal.hpp"

#include <regex>

#include "mechanics/active/contraction.hpp"
#include "mechanics/derivatives.hpp"
#include "mechanics/foundation.hpp"
#include "mechanics/matrix.hpp"
#include "mechanics/surroundings.hpp"
#include "simulation/tape.hpp"
#include "support/law_checks.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"

namespace {

// Two cells with signals of 1.5 and 4, which act by a quarter and in full: forces are those of laws on each cell alone,
// and follow from the energy, whose flow is their work. `law_of` makes a law of cells that follow a rule.
template <class LawOf>
void expect_to_act_by_signal(const LawOf& law_of) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  Motion motion = random_motion(tissue, 3, 6);
  Vectors expected(tissue.node_count(), Vec3::Zero());
  for (const auto& [cell, factor] : {std::pair(0, 0.25), {1, 1.0}}) {
    const auto alone = law_of(tissue, CellSet{cell == 0, cell == 1}, ShapeActivationRule());
    motion.internal = alone.first_internal(tissue);
    const Vectors forces = forces_of(alone, motion.step());
    for (std::size_t n = 0; n < forces.size(); ++n) expected[n] += factor * forces[n];
  }
  const auto law =
      law_of(tissue, CellSet{true, true},
             ShapeActivationRule{.kind = ShapeActivationRule::Kind::follows, .from = 1, .to = 3, .signal = 0});
  const std::vector<CellArray> signals = {CellArray{1.5, 4.0}};
  motion.internal = law.with_signals(law.first_internal(tissue), signals, 0);
  EXPECT_LE(largest_distance(forces_of(law, motion.step()), expected), 1e-12 * largest(expected));
  expect_forces_are_minus_energy_gradient(law, motion, 1e-6);
  expect_tangent_is_minus_force_gradient(law, motion, 1e-6);
  expect_assembled_is_matrix_free(law, motion, 7);
  EXPECT_THROW((void)law.derivatives(), NoGradient);
}

TEST(FollowedSignal, ScalesALayer) {
  expect_to_act_by_signal([](const Tissue& tissue, const CellSet& cells, const ShapeActivationRule& follow) {
    return MatrixLayer(tissue, cells, {.stiffness = 0.6, .prestretch = 1.1, .follow = follow});
  });
}

TEST(FollowedSignal, ScalesAFoundation) {
  for (const auto resists : {FoundationRule::Resists::all, FoundationRule::Resists::one_sided})
    expect_to_act_by_signal([&](const Tissue& tissue, const CellSet& cells, const ShapeActivationRule& follow) {
      return Foundation(tissue, cells, {.stiffness = 0.02, .resists = resists, .follow = follow});
    });
}

TEST(FollowedSignal, ScalesSprings) {
  expect_to_act_by_signal([](const Tissue& tissue, const CellSet& cells, const ShapeActivationRule& follow) {
    return Contraction(contraction_springs(tissue, cells, {.stiffness = 2, .diagonals = true, .preload = 3}),
                       Program({0, 2}, {0.2, 1}), cells, FollowedSignal(tissue, follow));
  });
}

TEST(FollowedSignal, ScalesAPressure) {
  expect_to_act_by_signal([](const Tissue& tissue, const CellSet& cells, const ShapeActivationRule& follow) {
    return FacePressure(tissue, CellSide::apical, cells, 0.3, Program({0, 2}, {0.2, 1}),
                        FollowedSignal(tissue, follow));
  });
}

// Damping is no activity.
TEST(FollowedSignal, LeavesTheDampingOfSprings) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  const std::vector<Spring> springs = contraction_springs(tissue, CellSet{true, true}, {.damping = 2});
  const Contraction law(springs, {}, CellSet{true, true},
                        FollowedSignal(tissue, {.kind = ShapeActivationRule::Kind::follows, .signal = 0}));
  Motion motion = random_motion(tissue, 3, 6);
  motion.internal = law.first_internal(tissue);
  EXPECT_EQ(forces_of(law, motion.step()), forces_of(Contraction(springs, {}), motion.step()));
}

// Cells of a block grow by a signal that they dilute: exactly by what they have at the beginning of each step.
TEST(FollowedSignal, CellsGrowByWhatTheyHave) {
  Simulation run(scenario_of("format = 1\n" + block_table(60, 20, 20, "3, 1, 1") + R"([region.left]
x_um = [-30, -10]
[signal.u]
initial = 2
initial_region = "left"
[growth.all]
region = "all"
rate_per_h = 6
follow = { signal = "u", from = 0, to = 4 }
[time]
end_min = 6
max_step_s = 5
[stop]
at_equilibrium = false
)"));
  const std::span<const double> targets = run.model().volumes.targets();
  const std::vector<double> first(targets.begin(), targets.end());
  const auto left =
      static_cast<std::size_t>(std::ranges::find(run.state().signals[0], 2.0) - run.state().signals[0].begin());
  double ln_volume = 0, before_s = 0, before = 2;
  while (run.step()) {
    ln_volume += 6.0 / 3600 * before / 4 * (run.time_s() - before_s);
    before_s = run.time_s(), before = run.state().signals[0][left];
    const std::vector<double> volumes = run.model().volumes.volumes(run.state().positions);
    for (std::size_t c = 0; c < volumes.size(); ++c)
      EXPECT_NEAR(volumes[c] / first[c], c == left ? std::exp(ln_volume) : 1, 1e-9);
  }
  EXPECT_EQ(run.status(), RunStatus::end_time) << run.failure();
  EXPECT_NEAR(std::exp(ln_volume), 1.3, 0.01);  // dV/dt = r u V/4, and u V is conserved
}

const std::string bonded = "format = 1\n" + block_table(60, 40, 10, "3, 2, 1") + R"([elasticity]
model = "neo-hookean"
young_modulus_Pa = 1000
[dynamics]
surface_drag_Pa_s_per_um = 100
[signal.u]
initial = 1
decay_per_min = 2
[matrix.below]
region = "all"
young_modulus_Pa = 30000
thickness_um = 0.1
prestretch = 1.3
[foundation.above]
region = "all"
faces = "apical"
stiffness_nN_per_um3 = 0.02
[time]
end_s = 60
step_s = 0.5
[stop]
at_equilibrium = false
)";

// A signal that decays does what a falling program does, and gives or costs the same energy.
TEST(FollowedSignal, FallsAsAProgramDoes) {
  std::string times, activities;
  for (int t = 0; t <= 60; ++t) {
    times += fmt::format("{}{}", t == 0 ? "" : ",", t);
    activities += fmt::format("{}{}", t == 0 ? "" : ",", std::exp(-t / 30.0));
  }
  const std::string springs = "[contraction.above]\nregion = \"all\"\nstiffness_nN_per_um = 0.5\n",
                    load = "[pressure.below]\nregion = \"all\"\nface = \"basal\"\npressure_Pa = 20\n";
  for (const auto& [table, active] : std::vector<std::pair<std::string, std::string>>{
           {"matrix.below", ""}, {"foundation.above", ""}, {"contraction.above", springs}, {"pressure.below", load}}) {
    // Beside springs and loads the layer is at rest: its contraction would undo most of their work.
    const std::string text =
        active.empty() ? bonded : std::regex_replace(bonded, std::regex("prestretch = 1.3"), "prestretch = 1") + active;
    Simulation follows(scenario_of(text, {table + ".follow={signal=\"u\",from=0,to=1}"})),
        falls(scenario_of(text, {fmt::format("{}.program={{time_s=[{}],activity=[{}]}}", table, times, activities)})),
        stays(scenario_of(text));
    for (Simulation* run : {&follows, &falls, &stays}) EXPECT_EQ(run->run(), RunStatus::end_time) << run->failure();
    const double change = largest_distance(falls.state().positions, stays.state().positions);
    EXPECT_GT(change, 0.1) << table;
    EXPECT_LT(largest_distance(follows.state().positions, falls.state().positions), 0.03 * change) << table;
    const std::size_t law = place_of_law(falls.model(), table);
    const EnergyFlow one = follows.memory().energies[law], other = falls.memory().energies[law];
    EXPECT_GT(other.dissipated + std::abs(other.active), 0);
    EXPECT_NEAR(one.dissipated, other.dissipated, 0.03 * other.dissipated) << table;
    EXPECT_NEAR(one.stored, other.stored, 0.03 * std::abs(other.stored) + 0.01 * other.dissipated) << table;
    // Cells act by the beginning of a step: by 1.7 % too much, and the work of a force is quadratic in it.
    EXPECT_NEAR(one.active, other.active, 0.05 * std::abs(other.active) + 1e-12) << table;
    // What acts suddenly at first, in steps of this length, leaves an error of its own.
    const auto imbalance = [](Simulation& run) { return std::abs(*run.measures()["energy_imbalance_ratio"]); };
    EXPECT_LT(imbalance(follows), 0.01 + (active.empty() ? 0 : imbalance(falls))) << table;
  }
}

// Through changes of the tissue and an activity set from outside, on other threads. Return the whole run.
Simulation expect_the_same_bits(const Scenario& scenario, const std::string& active) {
  Simulation whole(scenario);
  std::vector<RunMemory> memories;
  while (whole.step()) {
    if (whole.steps() == 12) whole.set_activity(active, std::vector<double>(whole.model().tissue.cells.size(), 0.5));
    memories.push_back(whole.memory());
  }
  EXPECT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  EXPECT_GT(whole.divisions(), 0);
  expect_to_end_alike(scenario, whole, memories, 14, memories.size() / 4);
  return whole;
}

const std::string by_u = "follow = { signal = \"u\", from = 0, to = 2 }\n";

TEST(FollowedSignal, RunsGoOnToTheSameBits) {
  const Scenario scenario = scenario_of(
      "format = 1\n" + exchanging_sheet +
          "[signal.u]\ninitial = 1\ninitial_spread = 0.5\ndiffusion_um2_per_min = 20\n"
          "[growth.all]\nregion = \"all\"\nrate_per_h = 3\n" +
          by_u + "[matrix.below]\nregion = \"all\"\nyoung_modulus_Pa = 1000\nthickness_um = 0.1\n" + by_u +
          "[foundation.below]\nregion = \"all\"\nstiffness_nN_per_um3 = 0.01\nresists = \"normal\"\n" + by_u +
          "[division.some]\nregion = \"all\"\nwhen = \"elongation_above\"\nthreshold = 1.6\n"
          "growth_s = 10\nplane = \"longest-axis\"\n",
      {"time.end_min=0.2"});
  EXPECT_GT(expect_the_same_bits(scenario, "growth.all").state().exchanges.count, 0);
}

// Of laws that are refused beside exchanges.
TEST(FollowedSignal, RunsOfSpringsAndPressuresGoOnToTheSameBits) {
  expect_the_same_bits(
      scenario_of("format = 1\n" + sheet_table(36, 36, 10, 36) +
                  "[elasticity]\nyoung_modulus_Pa = 200\n[dynamics]\nsurface_drag_Pa_s_per_um = 30\n"
                  "[signal.u]\ninitial = 1\ninitial_spread = 0.5\ndiffusion_um2_per_min = 20\n"
                  "[contraction.above]\nregion = \"all\"\nstiffness_nN_per_um = 0.3\n" +
                  by_u + "[pressure.below]\nregion = \"all\"\nface = \"basal\"\npressure_Pa = 20\n" + by_u +
                  "[division.some]\nregion = \"all\"\nat_s = 6\ngrowth_s = 10\nplane = \"longest-axis\"\n"
                  "[time]\nend_s = 12\nmax_step_s = 0.2\n[stop]\nat_equilibrium = false\n"),
      "contraction.above");
}

TEST(FollowedSignal, ErrorsNameTheRemedy) {
  const std::string growing = "[growth.a]\nregion = \"all\"\nrate_per_h = 1\n", signal = "[signal.u]\n";
  const WrongScenarios cases = {
      {growing + "follow = { signal = \"u\", from = 0, to = 1 }",
       "4: growth.a.follow.signal: no signal \"u\"; add [signal.u]"},
      {signal + growing + "follow = { signal = \"v\", from = 0, to = 1 }",
       "5: growth.a.follow.signal: no signal \"v\"; use one of: u"},
      {signal + growing + "follow = { from = 0, to = 1 }",
       "5: growth.a.follow.signal: is missing; set signal to the name of a [signal.NAME]"},
      {signal + growing + "follow = { signal = \"u\", from = 1 }",
       "5: growth.a.follow.to: is missing; set `to` to the value at which the factor is 1"},
      {signal + growing + "follow = { signal = \"u\", from = 1, to = 1 }",
       "5: growth.a.follow.to: equals `from`; set `to` to a different value"},
      {signal + growing + "follow = { measure = \"height_ratio\", from = 1, to = 2 }",
       "5: growth.a.follow.measure: unknown key; move it to [cortex.NAME]\n5: growth.a.follow.signal: is missing; set "
       "signal to the name of a [signal.NAME]"},
      {signal + "[foundation.a]\nregion = \"all\"\ndrag_Pa_s_per_um = 1\nfollow = { signal = \"u\", from = 0, to = 1 }",
       "5: foundation.a.follow: is not used without stiffness_nN_per_um3; remove it, or set stiffness_nN_per_um3"},
      {signal +
           "[contraction.a]\nregion = \"all\"\ndamping_nN_s_per_um = 1\nfollow = { signal = \"u\", from = 0, to = 1 }",
       "5: contraction.a.follow: is not used without stiffness, pre-tension or tension; remove it, or set "
       "stiffness_nN_per_um, preload_nN or tension_mN_per_m"},
      {"[pressure.a]\nregion = \"all\"\npressure_Pa = 1\nfollow = { signal = \"u\", from = 0, to = 1 }",
       "4: pressure.a.follow.signal: no signal \"u\"; add [signal.u]"},
  };
  expect_errors(cases, load_errors);
}

}  // namespace
