#include "study/quiet_run.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "core/files.hpp"
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

}  // namespace
}  // namespace plica
