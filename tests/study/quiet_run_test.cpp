#include "study/quiet_run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/files.hpp"
#include "record/archive.hpp"
#include "record/results.hpp"
#include "scenario/load.hpp"
#include "support/block_scenario.hpp"

namespace plica {
namespace {

TEST(QuietRun, ComesToWhatPlicaRunWrites) {
  namespace fs = std::filesystem;
  const ScenarioSource source = support::pulled_block();
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
  const Scenario scenario = load_scenario(support::pulled_block());
  const RunSummary ran = quiet_run(scenario), rest = run_at_rest(scenario);
  std::vector<std::string> ran_keys, rest_keys;
  for (const auto& [key, value] : ran.summary.items()) ran_keys.push_back(key);
  for (const auto& [key, value] : rest.summary.items()) rest_keys.push_back(key);
  EXPECT_EQ(ran_keys, rest_keys);
  EXPECT_EQ(rest.summary.at("all.volume_um3"), 96000);
}

TEST(QuietRun, StopsWhenAsked) {
  const Scenario scenario = load_scenario(support::pulled_block());
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
  const Scenario scenario_ = load_scenario(support::pulled_block(), {"time.step_s=0.1"});
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
  EXPECT_TRUE(std::ranges::equal(rest.rows, whole.rows, {}, &Observation::values, &Observation::values));
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
  RunSummary other =
      quiet_run(load_scenario(support::pulled_block(), {"time.step_s=0.1", "elasticity.young_modulus_Pa=900"}),
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
}  // namespace plica
