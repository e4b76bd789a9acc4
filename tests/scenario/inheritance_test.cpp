// Scenarios in files: inheritance through `base`, paths relative to a file, and places in messages.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "scenario/load.hpp"

namespace plica {
namespace {

/// Writes files into a temporary folder and removes them afterwards.
class LoadFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("plica_load_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    std::filesystem::create_directories(folder_ / "inner");
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  std::string errors_in(const std::string& path) const {
    try {
      load_scenario(find_scenario(path));
      return "";
    } catch (const ScenarioError& error) {
      return error.what();
    }
  }
  std::filesystem::path folder_;
};

TEST_F(LoadFiles, InheritsKeyByKey) {
  write("base.toml",
        "[time]\nend_min = 5\nstep_s = 1\n[region.a]\nface = \"left\"\n[expect]\ncells = { value = 1, within = 2 }\n");
  write("inner/middle.toml", "base = \"../base.toml\"\n[region.b]\nface = \"right\"\n[time]\nend_s = 7\n");
  const std::string top =
      write("top.toml",
            "base = \"inner/middle.toml\"\n[region.a]\ncells_along = 2\n[expect]\ncells = { within_percent = 3 }\n");
  const Scenario scenario = load_scenario(find_scenario(top));
  EXPECT_EQ(scenario.name, "top");
  EXPECT_EQ(scenario.time.end_s, 7);
  EXPECT_EQ(scenario.time.step_s, 1);
  EXPECT_EQ(scenario.regions.at("a").face, "left");
  EXPECT_EQ(scenario.regions.at("a").cells_along, 2);
  EXPECT_EQ(scenario.regions.at("b").face, "right");
  EXPECT_EQ(scenario.expect.at("cells").value, 1);
  EXPECT_FALSE(scenario.expect.at("cells").within.has_value());
  EXPECT_EQ(scenario.expect.at("cells").within_percent, 3);
}

TEST_F(LoadFiles, InheritsFromABuiltinAndDropsWhatAnotherShapeDoesNotUse) {
  const Scenario scenario = load_scenario(
      {"test", "test.toml",
       "base = \"drosophila\"\n[embryo]\nshape = \"sphere\"\ncells = [18, 9, 9]\n[region.furrow]\ncells_across = 3\n"});
  EXPECT_EQ(scenario.embryo.length_um, 280);
  EXPECT_EQ(scenario.regions.at("furrow").cells_across, 3);
  EXPECT_EQ(scenario.contractions.at("apical").region, "furrow");
}

TEST_F(LoadFiles, ReportsErrorsWhereTheyAreWritten) {
  const std::string base = write("base.toml", "format = 1\n[time]\nend_s = -5\n");
  const std::string top = write("top.toml", "base = \"base.toml\"\n[time]\nstep_s = -1\n");
  EXPECT_EQ(errors_in(top), base + ":3: time.end_s: -5 is out of range; set end_s to a number > 0\n" + top +
                                ":3: time.step_s: -1 is out of range; set step_s to a number >= 1e-06 or \"adaptive\"");
}

TEST_F(LoadFiles, RefusesCircularBases) {
  const std::string first = write("first.toml", "base = \"second.toml\"\n");
  const std::string second = write("second.toml", "format = 1\nbase = \"first.toml\"\n");
  EXPECT_EQ(errors_in(first),
            second + ":2: base: \"first.toml\" inherits from itself through its bases; remove one base of the cycle");
}

TEST_F(LoadFiles, FindsMeshesBesideTheFileThatNamesThem) {
  write("inner/base.toml", "[embryo]\nshape = \"file\"\nfile = \"mesh.vtu\"\n");
  const std::string top = write("top.toml", "base = \"inner/base.toml\"\n");
  EXPECT_EQ(load_scenario(find_scenario(top)).embryo.file, (folder_ / "inner" / "mesh.vtu").string());
}

}  // namespace
}  // namespace plica
