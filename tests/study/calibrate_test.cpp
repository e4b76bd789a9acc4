// Runs without files, calibration by them, and its search for targets.
#include "study/calibrate.hpp"

#include <unistd.h>

#include <cstdlib>

#include "core/files.hpp"
#include "record/archive.hpp"
#include "record/results.hpp"
#include "scenario/print.hpp"
#include "study/quiet_run.hpp"
#include "support/own_folder.hpp"
#include "support/scenarios.hpp"

namespace {

namespace fs = std::filesystem;

CalibrationProblem block_problem(const std::vector<std::string>& vary, const std::vector<std::string>& targets) {
  CalibrationProblem problem{pulled_block(), {}, {}, {}};
  for (const std::string& text : vary) problem.keys.push_back(parse_varied_key(text));
  for (const std::string& text : targets) problem.targets.push_back(parse_target(text));
  return problem;
}

const std::string stiffness = "contraction.all.stiffness_nN_per_um=0.1:20";
const std::string across = "contraction.all.across_ratio=0.1:4";

// The message of the UsageError or ScenarioError that it throws.
std::string refusal(const std::function<void()>& call) { return error_of<std::runtime_error>(call); }

TEST(CalibrationProblem, ReadsKeysAndTargets) {
  const VariedKey key = parse_varied_key("a.b=-1e-3:2.5");
  EXPECT_EQ(key.key, "a.b");
  EXPECT_EQ(key.low, -1e-3);
  EXPECT_EQ(key.high, 2.5);
  EXPECT_DOUBLE_EQ(parse_target("x=-200").within, 1);
  EXPECT_EQ(parse_target("x=-200").value, -200);
  EXPECT_EQ(parse_target("x=3~0.25").within, 0.25);
  EXPECT_EQ(parse_target("x=0~0.25").within, 0.25);
  EXPECT_DOUBLE_EQ(parse_target("x=50~4%").within, 2);
  EXPECT_EQ(parse_target("end.position_um=3").name, "end.position_um");
}

TEST(CalibrationProblem, RefusesWhatIsNone) {
  for (const char* text : {"", "a", "a=1", "=1:2", "a=1:", "a=:1", "a=1:2:3", "a=x:2", "a=1:nan", "a=1:inf", "a=1:1"}) {
    EXPECT_THROW((void)parse_varied_key(text), UsageError) << text;
  }
  for (const char* text : {"", "x", "=1", "x=", "x=y", "x=0", "x=0~5%", "x=1~", "x=1~0", "x=1~-1", "x=1~%", "x=nan"}) {
    EXPECT_THROW((void)parse_target(text), UsageError) << text;
  }
  EXPECT_SAYS(refusal([] { (void)parse_varied_key("a=2:1"); }), "write a=1:2");
}

TEST(CalibrationProblem, IsCheckedBeforeTheFirstRun) {
  const auto said = [](const std::vector<std::string>& vary, const std::vector<std::string>& targets,
                       const std::vector<std::string>& overrides = {}) {
    return refusal([&] {
      CalibrationProblem problem = block_problem(vary, targets);
      problem.overrides = overrides;
      check_calibration(problem);
    });
  };
  EXPECT_EQ(said({stiffness}, {"end.position_um=28"}), "");
  EXPECT_EQ(said({"contraction.all.stifness_nN_per_um=1:2"}, {"end.position_um=28"}),
            "--vary: contraction.all.stifness_nN_per_um: unknown key; use \"stiffness_nN_per_um\" (nearest match)");
  EXPECT_SAYS(said({"contraction.all.stiffness_nN_per_um=-1:2"}, {"end.position_um=28"}), "out of range");
  EXPECT_SAYS(said({"elasticity.poisson_ratio=0.3:0.7"}, {"end.position_um=28"}), "out of range")
      << "the upper bound too";
  EXPECT_SAYS(said({"region.x.cells_along=1:3"}, {"end.position_um=28"}), "vary a real-valued key");
  EXPECT_SAYS(said({stiffness}, {"end.positon_um=28"}), "use \"end.position_um\" (nearest match)");
  EXPECT_SAYS(said({stiffness}, {"wall_s=1"}), "differs between runs");
  EXPECT_SAYS(said({stiffness}, {"lip_distance_um=28"}), "add \"furrow\" to measure.sets");
  EXPECT_SAYS(said({stiffness}, {"status=1"}), "not a number of summary.json");
  EXPECT_SAYS(said({stiffness, stiffness}, {"end.position_um=28"}), "twice");
  EXPECT_SAYS(said({stiffness}, {"end.position_um=28", "end.position_um=27"}), "twice");
  EXPECT_SAYS(said({stiffness}, {"end.position_um=28"}, {"contraction.all.stiffness_nN_per_um=3"}),
              "conflicts with --set");
}

TEST(Calibrate, BeginsAtTheScenariosOwnValues) {
  CalibrationProblem problem = block_problem({"contraction.all.stiffness_nN_per_um=0:4", "time.end_min=1:3"}, {});
  EXPECT_EQ(first_place(problem), (std::vector<double>{0.25, 0.5})) << "the middle where there is none within";
  problem.overrides = {"contraction.all.stiffness_nN_per_um=3"};
  EXPECT_EQ(first_place(problem)[0], 0.75);
}

using CalibratedFile = OwnFolder;

TEST_F(CalibratedFile, MeetsTwoTargetsWithTwoKeys) {
  const CalibrationProblem problem =
      block_problem({stiffness, across}, {"end.position_um=28~0.01", "side.position_um=19.5~0.01"});
  const Calibration found = calibrate(problem);
  ASSERT_EQ(found.end, CalibrationEnd::met);
  std::cout << found.trials << " trials\n";
  EXPECT_LE(found.trials, 25);
  EXPECT_EQ(calibrate(problem).best->values, found.best->values) << "the search is the same each time";

  fs::create_directories(folder / "of mine");
  CalibrationProblem of_file = problem;
  of_file.source.file = (folder / "block.toml").string();
  write_file(of_file.source.file, of_file.source.text);
  const std::string file = (folder / "of mine" / "calibrated.toml").string();
  const std::string text = calibrated_toml(of_file, found, file);
  EXPECT_SAYS(text, "base = \"../block.toml\"");
  EXPECT_SAYS(text, "# Target: side.position_um = 19.5 within 0.01; result 19.");
  const Scenario written = load_scenario({"calibrated", file, text});
  const auto summary = quiet_run(written).summary;
  EXPECT_EQ(summary.at("end.position_um"), *found.best->found[0]);
  EXPECT_EQ(written.expect.at("side.position_um").value, 19.5);
  EXPECT_EQ(written.expect.at("side.position_um").within, 0.01);

  // A table set as a whole cannot be written above a key of it: the scenario is then written in full.
  of_file.overrides = {R"(contraction.all={region="all", damping_nN_s_per_um=0.5})", "elasticity.model=shape-memory"};
  const Scenario in_full = load_scenario({"calibrated", file, calibrated_toml(of_file, found, file)});
  EXPECT_EQ(in_full.contractions.at("all").damping_nN_s_per_um, 0.5);
  EXPECT_EQ(in_full.contractions.at("all").stiffness_nN_per_um, found.best->values[0]);
  of_file.overrides.erase(of_file.overrides.begin());
  const Scenario short_one = load_scenario({"calibrated", file, calibrated_toml(of_file, found, file)});
  EXPECT_EQ(short_one.elasticity.model, "shape-memory") << "bare words are quoted";
}

TEST(Calibrate, RunsThatFailHaveNoValue) {
  // The lower end gives up.
  CalibrationProblem problem = block_problem({"contraction.all.preload_nN=-1e6:0"}, {"end.position_um=28.1~0.1"});
  std::vector<Trial> failed;
  CalibrationHooks hooks;
  hooks.on_trial = [&](const Trial& trial, bool best) {
    if (trial.failure.empty()) return;
    failed.push_back(trial);
    EXPECT_FALSE(best);
    EXPECT_TRUE(std::isinf(trial.worst_miss));
  };
  const Calibration found = calibrate(problem, hooks);
  ASSERT_FALSE(failed.empty());
  EXPECT_EQ(found.end, CalibrationEnd::met);
  EXPECT_EQ(found.best->values, std::vector<double>{0});
}

TEST(Calibrate, KeepsToItsTrials) {
  CalibrationProblem problem = block_problem({stiffness}, {"end.position_um=28~1e-9"});
  problem.most_trials = 3;
  const Calibration spent = calibrate(problem);
  EXPECT_EQ(spent.end, CalibrationEnd::trials_spent);
  EXPECT_EQ(spent.trials, 3);
}

using Place = std::vector<double>;

struct Searched {
  int evaluations = 0;
  double best = std::numeric_limits<double>::infinity();
  Place where;
};

// Searches with a function for the runs, for at most 100 evaluations.
Searched search(const Place& start, std::size_t targets, const std::function<std::vector<double>(const Place&)>& run) {
  Searched searched;
  search_targets(start, targets, [&](const Place& place) {
    const std::vector<double> misses = run(place);
    for (const double x : place) EXPECT_TRUE(x >= 0 && x <= 1) << x;
    ++searched.evaluations;
    if (worst_miss(misses) < searched.best) searched.best = worst_miss(misses), searched.where = place;
    return Evaluation{misses, worst_miss(misses) <= 1 || searched.evaluations >= 100};
  });
  return searched;
}

TEST(TargetSearch, OneKeyOneTargetIsBracketed) {
  const Searched found = search({0.9}, 1, [](const Place& x) { return Place{(std::exp(x[0]) - 1.5) * 1000}; });
  EXPECT_LE(found.best, 1);
  EXPECT_NEAR(found.where[0], std::log(1.5), 1e-3);
  EXPECT_LE(found.evaluations, 6);
}

TEST(TargetSearch, EndsThatDoNotBracketMayHideAMeetingPlace) {
  const Searched found = search({0.5}, 1, [](const Place& x) { return Place{300 * (0.02 - std::pow(x[0] - 0.6, 2))}; });
  EXPECT_LE(found.best, 1);
  EXPECT_LE(found.evaluations, 20);
}

TEST(TargetSearch, FindsTheNearestWhereNothingMeets) {
  const Searched inside = search({0.5}, 1, [](const Place& x) { return Place{100 + 100 * std::pow(x[0] - 0.6, 2)}; });
  EXPECT_NEAR(inside.where[0], 0.6, 0.05);
  const Searched at_bound = search({0.5}, 1, [](const Place& x) { return Place{100 + 100 * x[0]}; });
  EXPECT_EQ(at_bound.where, Place{0});
  EXPECT_LE(std::max(inside.evaluations, at_bound.evaluations), 25) << "it ends when it gets nowhere";
}

TEST(TargetSearch, SeveralKeysAndTargets) {
  const Searched two = search({0.5, 0.5}, 2, [](const Place& x) {
    return Place{7 * (28 * x[0] * std::sqrt(0.3 + x[1]) - 14), 30 * ((1 + x[1]) / (0.2 + x[0]) - 3)};
  });
  const Searched three = search({0.5, 0.5, 0.5}, 3, [](const Place& x) {
    return Place{200 * (std::exp(x[0]) * x[1] - 0.5), 200 * (x[0] + x[1] * x[2] - 0.6),
                 200 * (x[2] * x[2] - x[0] - 0.2)};
  });
  std::cout << two.evaluations << " evaluations with two keys, " << three.evaluations << " with three\n";
  EXPECT_LE(two.best, 1);
  EXPECT_LE(two.evaluations, 12);
  EXPECT_LE(three.best, 1);
  EXPECT_LE(three.evaluations, 20);
}

TEST(TargetSearch, MoreTargetsThanKeysAndFewer) {
  const Searched more = search({0.9}, 2, [](const Place& x) { return Place{100 * (x[0] - 0.4), 100 * (x[0] - 0.6)}; });
  EXPECT_NEAR(more.where[0], 0.5, 0.01) << "the largest miss is least in the middle";
  EXPECT_NEAR(more.best, 10, 1);
  const Searched fewer = search({0.5, 0.5}, 1, [](const Place& x) { return Place{200 * (x[0] * x[1] - 0.8)}; });
  EXPECT_LE(fewer.best, 1);
}

TEST(TargetSearch, GoesOnWhereThereIsNoValue) {
  const auto hole = [](double low, double high) {
    return [=](const Place& x) { return x[0] > low && x[0] < high ? Place{} : Place{100 * (x[0] - 0.3)}; };
  };
  // At an end, inside the bracket, at the start of the search without a bracket.
  for (const auto& run : {hole(0.9, 2), hole(-1, 0.05), hole(0.35, 0.7)}) {
    EXPECT_LE(search({0.5}, 1, run).best, 1);
  }
  const Searched none = search({0.5, 0.5}, 2, [](const Place&) { return Place{}; });
  EXPECT_TRUE(std::isinf(none.best));
  EXPECT_LE(none.evaluations, 25);
}

TEST(QuietRun, ComesToWhatPlicaRunWrites) {
  namespace fs = std::filesystem;
  const ScenarioSource source = pulled_block();
  const RunSummary quiet = quiet_run(load_scenario(source));
  const fs::path folder = fs::path(testing::TempDir()) / ("plica_quiet_" + std::to_string(::getpid()));
  write_file(folder.string() + ".toml", source.text);
  const std::string command =
      std::string(PLICA_PROGRAM) + " run " + folder.string() + ".toml --quiet --out " + folder.string();
  ASSERT_EQ(std::system(command.c_str()), 0);
  auto written = read_summary(folder), ours = quiet.summary;
  EXPECT_EQ(read_series(folder / "series.csv").rows.size(), quiet.rows.size());
  fs::remove_all(folder);
  fs::remove(folder.string() + ".toml");
  for (auto* summary : {&written, &ours})
    for (const char* key : {"scenario", "wall_s", "wall_solver_s", "peak_memory_MB", "provenance"}) summary->erase(key);
  EXPECT_EQ(written, ours);
  EXPECT_EQ(quiet.state.time_s, quiet.rows.back().time_s());
}

TEST(QuietRun, AtRestHasTheSameKeys) {
  const Scenario scenario = load_scenario(pulled_block());
  const RunSummary ran = quiet_run(scenario), rest = run_at_rest(scenario);
  std::vector<std::string> ran_keys, rest_keys;
  for (const auto& [key, value] : ran.summary.items()) ran_keys.push_back(key);
  for (const auto& [key, value] : rest.summary.items()) rest_keys.push_back(key);
  EXPECT_EQ(ran_keys, rest_keys);
  EXPECT_EQ(rest.summary.at("all.volume_um3"), 96000);
}

TEST(QuietRun, StopsWhenAsked) {
  const Scenario scenario = load_scenario(pulled_block());
  int rows = 0;
  const RunSummary run = quiet_run(scenario, {[&] { return rows >= 2; }, [&](const Observation&) { ++rows; }});
  EXPECT_EQ(run.summary.at("status"), "interrupted");
  EXPECT_EQ(rows, 2);
}

/// A run that is stopped after some steps, and then begun again.
class KeptQuietRun : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_archive()) GTEST_SKIP() << "without HDF5";
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  RunSummary run(int most_steps) {
    steps_ = 0;
    const auto leave_out = [](const Column& column) { return column.is_costly; };
    return quiet_run(scenario_, {[=, this] { return steps_ >= most_steps; }, [&](const Observation&) { ++steps_; },
                                 leave_out, place_, 0});
  }
  static std::string results_of(RunSummary run) {
    for (const char* key : {"wall_s", "wall_solver_s", "peak_memory_MB"}) run.summary.erase(key);
    return run.summary.dump();
  }
  const std::filesystem::path folder_ =
      std::filesystem::path(testing::TempDir()) / ("plica_kept_" + std::to_string(::getpid()));
  const std::filesystem::path place_ = folder_ / "unfinished" / "1";
  const Scenario scenario_ = load_scenario(pulled_block(), {"time.step_s=0.1"});
  int steps_ = 0;
};

TEST_F(KeptQuietRun, GoesOnToTheSameBits) {
  const RunSummary whole = run(1000);
  const int all_steps = steps_;
  EXPECT_FALSE(std::filesystem::exists(folder_ / "unfinished"));
  EXPECT_EQ(run(25).summary.at("status"), "interrupted");
  EXPECT_TRUE(std::filesystem::exists(place_ / "checkpoint.h5"));
  const RunSummary rest = run(1000);
  EXPECT_LT(steps_, all_steps);
  EXPECT_EQ(results_of(rest), results_of(whole));
  ASSERT_EQ(rest.rows.size(), whole.rows.size());
  // Columns that are left out have a value at rest only, which no result has.
  for (std::size_t k = 1; k < whole.rows.size(); ++k) EXPECT_EQ(rest.rows[k].values, whole.rows[k].values);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "unfinished"));
}

TEST_F(KeptQuietRun, BeginsAnewWhereNothingKeptFits) {
  const RunSummary whole = run(1000);
  const int all_steps = steps_;
  run(25);
  for (const char* name : {"checkpoint.h5", "checkpoint.previous.h5"}) write_file(place_ / name, "damaged");
  EXPECT_EQ(results_of(run(1000)), results_of(whole));
  EXPECT_EQ(steps_, all_steps);
  run(25);
  RunSummary other = quiet_run(load_scenario(pulled_block(), {"time.step_s=0.1", "elasticity.young_modulus_Pa=900"}),
                               {{}, {}, {}, place_, 0});
  EXPECT_NE(results_of(other), results_of(whole));
  EXPECT_FALSE(std::filesystem::exists(place_)) << "replaced, then removed";
}

TEST_F(KeptQuietRun, IsNotKeptTwice) {
  std::filesystem::create_directories(place_);
  const DirectoryLock lock(place_);
  run(25);
  EXPECT_FALSE(std::filesystem::exists(place_ / "checkpoint.h5"));
}

}  // namespace
