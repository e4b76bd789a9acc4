// Arrays of cells given to any shape, by a table or by a program.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "core/errors.hpp"
#include "mechanics/active/contraction.hpp"
#include "scenario/load.hpp"
#include "scenario/print.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

const std::string block =
    "[embryo]\nshape = \"block\"\nlength_um = 40\nwidth_um = 40\ncells = [2, 2, 1]\n"
    "cell_arrays = \"plica_arrays.csv\"\n[vitelline]\nenabled = false\n";

class CellArrays : public testing::Test {
 protected:
  CellArrays()
      : folder_(std::filesystem::path(testing::TempDir()) / ("plica_arrays_of_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~CellArrays() override { std::filesystem::remove_all(folder_); }

  [[nodiscard]] Scenario load(const std::string& table, const std::string& more = "") const {
    std::ofstream(folder_ / "plica_arrays.csv") << table;
    return load_scenario({"block", (folder_ / "block.toml").string(), block + more});
  }
  [[nodiscard]] std::string errors_of(const Scenario& scenario) const {
    try {
      make_model(scenario);
      return "";
    } catch (const ScenarioError& error) {
      return error.what();
    }
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(CellArrays, OfATableSelectAndGradeCells) {
  const Scenario scenario =
      load("myosin\n0\n1\n0.5\n0\n",
           "[region.active]\narray = \"myosin\"\n[contraction.apical]\nregion = \"active\"\n"
           "stiffness_nN_per_um = 1\nprofile = { shape = \"array\", array = \"myosin\", from = 0, to = 1 }\n");
  const auto model = make_model(scenario);
  EXPECT_EQ(model->tissue.cell_arrays.at("myosin"), (CellArray{0, 1, 0.5, 0}));
  EXPECT_EQ(model->tissue.regions.at("active"), (CellSet{false, true, true, false}));
  const auto resolved = make_tissue(load_scenario({"again", "again", resolved_toml(scenario)}));
  EXPECT_EQ(resolved.cell_arrays, model->tissue.cell_arrays);  // its path does not depend on the folder
}

TEST_F(CellArrays, OfAProgramReplaceThoseOfATable) {
  Scenario scenario = load("myosin,sna\n0,1\n1,1\n0.5,1\n0,1\n");
  scenario.embryo.arrays = {{"myosin", {1, 2, 3, 4}}};
  const Tissue tissue = make_tissue(scenario);
  EXPECT_EQ(tissue.cell_arrays.at("myosin"), (CellArray{1, 2, 3, 4}));
  EXPECT_EQ(tissue.cell_arrays.at("sna"), (CellArray{1, 1, 1, 1}));
}

TEST_F(CellArrays, OfAnotherNumberOfCellsAreRefused) {
  EXPECT_NE(errors_of(load("myosin\n0\n1\n")).find("embryo.cell_arrays: "), std::string::npos);
  EXPECT_NE(errors_of(load("myosin\n0\n1\n")).find("has 2 values for 4 cells; give one per cell"), std::string::npos);
  Scenario scenario = load("myosin\n0\n1\n2\n3\n");
  scenario.embryo.arrays = {{"calcium", {1}}};
  EXPECT_NE(errors_of(scenario).find("an array given has 1 values for 4 cells"), std::string::npos);
  EXPECT_NE(errors_of(load("myosin\nmuch\n")).find("\"much\" of column myosin is not a number"), std::string::npos);
}

}  // namespace
}  // namespace plica
