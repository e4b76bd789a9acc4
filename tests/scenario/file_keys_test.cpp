// Keys of files: meshes, points, bases.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/files.hpp"
#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "support/own_folder.hpp"
#include "support/scenarios.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using namespace support;

class FileKeys : public OwnFolder {
 protected:
  /// Three squares of this size in a row, one apart from them if asked for, with a number each.
  void write_squares(double size_um, const std::string& values = "1 nan 3", bool apart = false) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(apart ? 12 : 8) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                       std::to_string(apart ? 4 : 3) +
                       "\nproperty list int int vertex_indices\nproperty double gene\nend_header\n";
    const auto vertex = [&](double x, double y) {
      text += std::to_string(size_um * x) + ' ' + std::to_string(size_um * y) + " 0\n";
    };
    for (const int y : {0, 1})
      for (int x = 0; x < 4; ++x) vertex(x, y);
    if (apart)
      for (const int corner : {0, 1, 2, 3}) vertex(7 + (corner == 1 || corner == 2), corner / 2);
    std::istringstream each(values);
    std::string value;
    for (int f = 0; f < 3 && each >> value; ++f)
      text += "4 " + std::to_string(f) + ' ' + std::to_string(f + 1) + ' ' + std::to_string(f + 5) + ' ' +
              std::to_string(f + 4) + ' ' + value + '\n';
    if (apart) text += "4 8 9 10 11 9\n";
    write("a.ply", text);
  }

  [[nodiscard]] std::string squares(const std::string& keys = "") const {
    return "format = 1\n[embryo]\nshape = \"surface\"\nfile = \"" + (folder / "a.ply").string() +
           "\"\ncell_height_um = 10\n" + keys;
  }

  static Tissue tissue(const std::string& text) { return make_tissue(load_scenario({"test", "test.toml", text})); }

  static std::string advice_on(const std::string& text) {
    const Scenario scenario = load_scenario({"test", "test.toml", text});
    std::string lines;
    for (const std::string& line : advice(scenario, *make_model(scenario))) lines += line + '\n';
    return lines;
  }
};

TEST_F(FileKeys, AWrongUnitIsWarnedOfAndTheScaleNamedHelps) {
  for (const auto& [size_um, scale] : {std::pair(0.01, "[1000, 1000, 1000]"),
                                       {1e-5, "[1e+06, 1e+06, 1e+06]"},
                                       {2e4, "[0.001, 0.001, 0.001]"},
                                       {400.0, "[0.01, 0.01, 0.01]"}}) {
    write_squares(size_um);
    const std::string said = advice_on(squares());
    EXPECT_NE(said.find("warning: embryo.scale: cells of the file are "), std::string::npos) << said;
    EXPECT_NE(said.find(std::string("set embryo.scale = ") + scale), std::string::npos) << said;
    EXPECT_EQ(advice_on(squares("scale = " + std::string(scale) + "\n")).find("embryo.scale"), std::string::npos);
  }
  write_squares(10);
  EXPECT_EQ(advice_on(squares()).find("embryo.scale"), std::string::npos);
}

TEST_F(FileKeys, EveryShapeIsScaledThenTurnedThenCentred) {
  write_squares(10);
  const std::string keys = "scale = [2, 1, 1]\nrotate_deg = [0, 0, 90]\ncentre = true\n";
  const Tissue turned = tissue(squares(keys));
  for (std::size_t c = 0; c < 3; ++c) {
    const Vec3 centre = cell_centre(turned.cells[c], turned.rest_positions);
    EXPECT_NEAR(centre.x(), 0, 1e-9);
    EXPECT_NEAR(centre.y(), 20.0 * (static_cast<double>(c) - 1), 1e-9);
  }
  // Hexahedra, of which the volume is centred.
  const Tissue block = build_block({60, 20, 30, {3, 1, 1}, {1, 1, 1}});
  Scenario scenario = load_scenario(
      {"test", "test.toml",
       "format = 1\n[embryo]\nshape = \"file\"\nfile = \"a.vtu\"\n" + keys + "[vitelline]\nenabled = false\n"});
  auto mesh = std::make_shared<HexahedralMesh>();
  mesh->points = block.rest_positions;
  for (Vec3& point : mesh->points) point += Vec3(5, 6, 7);
  mesh->cells = block.elements;
  mesh->apical_faces = {5, 5, 5};
  scenario.embryo.mesh = mesh;
  const Tissue moved = make_tissue(scenario);
  for (std::size_t n = 0; n < moved.node_count(); ++n) {
    const Vec3& before = block.rest_positions[n];
    EXPECT_LT((moved.rest_positions[n] - Vec3(-before.y(), 2 * before.x(), before.z())).norm(), 1e-9);
  }
  EXPECT_NE(
      model_errors(squares("rotate_deg = [90]\n")).find("embryo.rotate_deg: has length 1; set rotate_deg to three"),
      std::string::npos);
}

TEST_F(FileKeys, PointsAreTurnedAndCentredToo) {
  std::string table = "x_um,y_um,z_um\n";
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0, r = std::sqrt(1 - z * z), turn = 2.4 * i;
    table += std::to_string(500 + 60 * r * std::sin(turn)) + ',' + std::to_string(60 * r * std::cos(turn)) + ',' +
             std::to_string(120 * z) + '\n';
  }
  write("points.csv", table);
  const Tissue turned =
      tissue("format = 1\n[embryo]\nshape = \"points\"\nfile = \"" + (folder / "points.csv").string() +
             "\"\ncell_height_um = 15\nrotate_deg = [0, 90, 0]\ncentre = true\n");
  ASSERT_EQ(turned.cells.size(), 200U);
  const Vec3 first = cell_centre(turned.cells.front(), turned.rest_positions);
  EXPECT_GT(first.x(), 90);
}

TEST_F(FileKeys, PiecesAreNamedAndTheLargestIsKept) {
  write_squares(10, "1 2 3", true);
  const std::string said = model_errors(squares());
  EXPECT_NE(said.find("the surface is not one piece but 2 pieces of 3 and 1 cells; face 3 at (75, 5, 0) um is joined"),
            std::string::npos)
      << said;
  EXPECT_NE(said.find("set embryo.keep = \"largest\""), std::string::npos);
  const Tissue kept = tissue(squares("keep = \"largest\"\n[region.r]\narray = \"gene\"\nabove = 1.5\n"));
  EXPECT_EQ(kept.cells.size(), 3U);
  EXPECT_EQ(kept.cell_arrays.at("gene"), (CellArray{1, 2, 3}));
  EXPECT_EQ(kept.regions.at("r"), (CellSet{false, true, true}));
  EXPECT_EQ(kept.remarks.front(), "the largest of 2 pieces of 3 and 1 cells was kept");
}

TEST_F(FileKeys, CellsWithoutAValueBelongToNoRegionAndNoProfile) {
  write_squares(10);
  for (const std::string bounds : {"", "above = 0\n", "below = 5\n", "above = -1\nbelow = 9\n"}) {
    const Tissue made = tissue(squares("[region.r]\narray = \"gene\"\n" + bounds));
    EXPECT_EQ(made.regions.at("r"), (CellSet{true, false, true})) << bounds;
    EXPECT_EQ(made.remarks.back(),
              "array \"gene\" has no value in 1 cells, which belong to no region by it; result files omit it");
  }
  const std::string acts =
      "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1\nprofile = { shape = \"array\", array = \"gene\", "
      "from = 0, to = 1 }\n";
  EXPECT_NE(model_errors(squares(acts)).find("profile.array: array \"gene\" has no value in cell 1 at (15, 5, -5) um"),
            std::string::npos)
      << model_errors(squares(acts));
  EXPECT_NE(model_errors(squares("cell_height_array = \"gene\"\n"))
                .find("embryo.cell_height_array: array \"gene\" has no value in face 1"),
            std::string::npos);
}

TEST_F(FileKeys, CellsAndRegionsThatDoNotExistAreErrors) {
  write_squares(10);
  const std::string sheet =
      "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 60\nwidth_um = 40\ncell_count = 12\ncell_height_um = 10\n";
  for (const std::string& text : {squares(), sheet}) {
    const std::string last = text == sheet ? "11" : "2";
    const std::string said = model_errors(text + "[region.r]\nids = [0, 99]\n");
    EXPECT_NE(said.find("region.r.ids: cell 99 does not exist; set ids to numbers from 0 to " + last),
              std::string::npos)
        << said;
    EXPECT_EQ(model_errors(text + "[region.r]\nids = [0, " + last + "]\n"), "");
  }
  const std::string acts = "[contraction.c]\nregion = \"gene\"\nstiffness_nN_per_um = 1\n";
  const std::string said = model_errors(squares(acts));
  EXPECT_NE(said.find("region \"gene\" does not exist"), std::string::npos) << said;
  EXPECT_NE(said.find("add [region.gene] with array = \"gene\""), std::string::npos) << said;
  EXPECT_EQ(model_errors(squares(acts + "[region.gene]\narray = \"gene\"\n")), "");
}

// Three cells of two triangles each about one point.
TEST_F(FileKeys, TrianglesOfOneLabelAreACell) {
  write_file(folder / "a.ply",
             "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty double z\n"
             "element face 6\nproperty list int int vertex_indices\nproperty int label\nend_header\n"
             "0 0 0\n10 0 0\n5 8.7 0\n-5 8.7 0\n-10 0 0\n-5 -8.7 0\n5 -8.7 0\n"
             "3 0 1 2 7\n3 0 2 3 7\n3 0 3 4 3\n3 0 4 5 3\n3 0 5 6 5\n3 0 6 1 5\n");
  const Tissue made = tissue(squares("mend = false\nlabel_array = \"label\"\n"));
  EXPECT_EQ(made.cell_arrays.at("label"), (CellArray{3, 5, 7}));
  for (const Cell& cell : made.cells) EXPECT_EQ(cell.sides(), 3U);
  const std::string said = advice_on(squares("mend = false\n"));
  EXPECT_NE(said.find("note: its 6 faces are triangles with 3 values of \"label\"; if these number the cells, set "
                      "embryo.label_array = \"label\""),
            std::string::npos)
      << said;
  EXPECT_NE(model_errors(squares("label_array = \"cell\"\n")).find("no array \"cell\" of its faces; there are: label"),
            std::string::npos);
}

class LoadFiles : public OwnFolder {
 protected:
  LoadFiles() { std::filesystem::create_directories(folder / "inner"); }
  static std::string errors_in(const std::string& path) {
    return support::errors_in([&] { return load_scenario(find_scenario(path)); });
  }
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
  EXPECT_EQ(load_scenario(find_scenario(top)).embryo.file, (folder / "inner" / "mesh.vtu").string());
}

}  // namespace
}  // namespace plica
