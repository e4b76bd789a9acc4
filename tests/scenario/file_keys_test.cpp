// Keys of files (meshes, points, bases), of sheets and embryos of polygons, and of periods.
#include "core/files.hpp"
#include "scenario/advice.hpp"
#include "support/own_folder.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

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

  static Tissue tissue(const std::string& text) { return make_tissue(scenario_of(text)); }

  static std::string advice_on(const std::string& text) {
    const Scenario scenario = scenario_of(text);
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
    EXPECT_SAYS(said, "warning: embryo.scale: cells of the file are ");
    EXPECT_SAYS(said, std::string("set embryo.scale = ") + scale);
    EXPECT_SAYS_NOT(advice_on(squares("scale = " + std::string(scale) + "\n")), "embryo.scale");
  }
  write_squares(10);
  EXPECT_SAYS_NOT(advice_on(squares()), "embryo.scale");
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
  EXPECT_SAYS(model_errors(squares("rotate_deg = [90]\n")), "embryo.rotate_deg: has length 1; set rotate_deg to three");
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
  EXPECT_SAYS(said, "the surface is not one piece but 2 pieces of 3 and 1 cells; face 3 at (75, 5, 0) um is joined");
  EXPECT_SAYS(said, "set embryo.keep = \"largest\"");
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
  EXPECT_SAYS(model_errors(squares(acts)), "profile.array: array \"gene\" has no value in cell 1 at (15, 5, -5) um");
  EXPECT_SAYS(model_errors(squares("cell_height_array = \"gene\"\n")),
              "embryo.cell_height_array: array \"gene\" has no value in face 1");
}

TEST_F(FileKeys, CellsAndRegionsThatDoNotExistAreErrors) {
  write_squares(10);
  const std::string sheet =
      "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 60\nwidth_um = 40\ncell_count = 12\ncell_height_um = 10\n";
  for (const std::string& text : {squares(), sheet}) {
    const std::string last = text == sheet ? "11" : "2";
    const std::string said = model_errors(text + "[region.r]\nids = [0, 99]\n");
    EXPECT_SAYS(said, "region.r.ids: cell 99 does not exist; set ids to numbers from 0 to " + last);
    EXPECT_EQ(model_errors(text + "[region.r]\nids = [0, " + last + "]\n"), "");
    EXPECT_EQ(said.find("label"), std::string::npos);
  }
  const std::string acts = "[contraction.c]\nregion = \"gene\"\nstiffness_nN_per_um = 1\n";
  const std::string said = model_errors(squares(acts));
  EXPECT_SAYS(said, "region \"gene\" does not exist");
  EXPECT_SAYS(said, "add [region.gene] with array = \"gene\"");
  EXPECT_EQ(model_errors(squares(acts + "[region.gene]\narray = \"gene\"\n")), "");
  std::string labelled = read_file(folder / "a.ply", 100'000);
  labelled.replace(labelled.find("gene"), 4, "label");
  write("a.ply", labelled);
  EXPECT_SAYS(model_errors(squares("[region.r]\nids = [99]\n")),
              "set ids to numbers from 0 to 2; label 99 is array = \"label\", above = 98.5, below = 99.5");
}

// Three cells of two triangles each about one point.
TEST_F(FileKeys, TrianglesOfOneLabelAreACell) {
  write_file(
      folder / "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 7\nproperty double x\nproperty double y\nproperty double z\nelement face "
      "6\nproperty list int int vertex_indices\nproperty int label\nend_header\n0 0 0\n10 0 0\n5 8.7 0\n-5 8.7 0\n-10 "
      "0 0\n-5 -8.7 0\n5 -8.7 0\n3 0 1 2 7\n3 0 2 3 7\n3 0 3 4 3\n3 0 4 5 3\n3 0 5 6 5\n3 0 6 1 5\n");
  const Tissue made = tissue(squares("mend = false\nlabel_array = \"label\"\n"));
  EXPECT_EQ(made.cell_arrays.at("label"), (CellArray{3, 5, 7}));
  for (const Cell& cell : made.cells) EXPECT_EQ(cell.sides(), 3U);
  const std::string said = advice_on(squares("mend = false\n"));
  EXPECT_SAYS(said,
              "note: its 6 faces are triangles with 3 values of \"label\"; if these number the cells, set "
              "embryo.label_array = \"label\"");
  EXPECT_SAYS(model_errors(squares("label_array = \"cell\"\n")), "no array \"cell\" of its faces; there are: label");
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

TEST(PolygonKeys, RegionsByAngleAndLength) {
  const Scenario scenario = scenario_of(egg +
                                        "[region.belly]\nangle_deg = [-40, 60]\nlength_percent = [25, "
                                        "80]\n[region.rest]\nunion = [\"all\"]\nexcept = [\"belly\"]\n");
  const Tissue tissue = make_tissue(scenario);
  int inside = 0;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Vec3 centre = cell_centre(tissue.cells[c], tissue.rest_positions);
    const double angle = std::atan2(centre.y(), -centre.z()) * 180 / std::numbers::pi;
    // The egg is 250 long, so that 25 % are 62.5 from its end.
    const bool is_in = angle >= -40 && angle <= 60 && centre.x() >= -62.5 && centre.x() <= 75;
    if (std::abs(centre.x() + 62.5) > 1 && std::abs(centre.x() - 75) > 1) {
      EXPECT_EQ(tissue.regions.at("belly")[c], is_in) << c;
    }
    EXPECT_NE(tissue.regions.at("belly")[c], tissue.regions.at("rest")[c]);
    inside += is_in;
  }
  EXPECT_GT(inside, 20);
}

TEST_F(FileKeys, RegionsOfMeasuredArrays) {
  const std::string table = numbered_points("gene");
  write_file(folder / "points.csv", table);
  const std::string points = "format = 1\n[embryo]\nshape = \"points\"\nfile = \"points.csv\"\ncell_height_um = 15\n";
  const auto tissue_of = [&](const std::string& regions) {
    return make_tissue(load_scenario({"test", (folder / "test.toml").string(), points + regions}));
  };
  const Tissue tissue = tissue_of(
      "[region.some]\narray = \"gene\"\nabove = 50\nbelow = 60\n[region.any]\narray = \"gene\"\n[region.low]\narray = "
      "\"gene\"\nbelow = 3\n");
  for (std::size_t c = 0; c < 200; ++c) {
    EXPECT_EQ(tissue.regions.at("some")[c], c > 50 && c < 60);
    EXPECT_EQ(tissue.regions.at("any")[c], c != 0);
    EXPECT_EQ(tissue.regions.at("low")[c], c < 3);
  }
  EXPECT_THROW(tissue_of("[region.r]\narray = \"other\"\n"), ScenarioError);
  write_file(folder / "points.csv", table + "0,0,61,1\n0,0,61,1\n");
  EXPECT_THROW(tissue_of(""), ScenarioError);
}

TEST(PolygonKeys, AHeldRimIsHeldAndNothingElse) {
  const std::string sheet =
      "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = "
      "9\nrim = ";
  const auto held = make_model(scenario_of(sheet + "\"held\"\n"));
  std::size_t at_rim = 0;
  for (std::size_t n = 0; n < held->tissue.free_node_count(); ++n) {  // those that hang follow
    const Vec3& x = held->tissue.rest_positions[n];
    const bool is_at_rim = std::abs(x.x()) == 30 || std::abs(x.y()) == 20;
    EXPECT_EQ(held->held[n], (std::array{is_at_rim, is_at_rim, is_at_rim})) << n;
    at_rim += is_at_rim;
  }
  EXPECT_GT(at_rim, 40U);
  const auto free = make_model(scenario_of(sheet + "\"free\"\n"));
  for (const auto& node : free->held) EXPECT_EQ(node, (std::array{false, false, false}));
}

TEST(PolygonKeys, ARegionSelectedAnewDropsWhatAnotherShapeSelectedItBy) {
  const auto load = [](const std::string& text) { return scenario_of(text); };
  const std::string base = "base = \"drosophila\"\n", shape = "[embryo]\nshape = \"egg\"\ncell_count = 300\n",
                    belly = "[region.furrow]\nangle_deg = [-30, 30]\n";
  const RegionInput furrow = load(base + shape + belly).regions.at("furrow");
  EXPECT_EQ(furrow.face, "");
  EXPECT_FALSE(furrow.cells_along || furrow.cells_across);
  EXPECT_TRUE(furrow.angle_deg);
  // For shapes with faces, selectors are intersected.
  EXPECT_EQ(load(base + belly).regions.at("furrow").face, "ventral");
  // Likewise for arrays.
  const std::string pill =
      "base = \"drosophila-atlas\"\n[embryo]\nshape = \"pill\"\n[region.mesoderm]\nface = \"left\"\n";
  EXPECT_EQ(load(pill).regions.at("mesoderm").array, "");
  EXPECT_FALSE(load(pill).regions.at("mesoderm").above);

  const std::string inherited = model_errors(base + shape),
                    own = model_errors(base + shape + belly + "face = \"left\"\n");
  EXPECT_TRUE(inherited.starts_with("drosophila:")) << inherited;
  EXPECT_SAYS(inherited, "region.furrow.face: cells of this shape have no named faces; use angle_deg, ");
  EXPECT_SAYS(inherited, "a new selector in [region.furrow] replaces the inherited face");
  EXPECT_EQ(own.find("test.toml:7: region.furrow.face: cells of this shape"), 0U) << own;
}

TEST(PolygonKeys, WhatIsWrongIsSaidWithItsKey) {
  const auto expect = [](const std::string& text, const std::string& said) { EXPECT_SAYS(model_errors(text), said); };
  expect("format = 1\n[embryo]\nshape = \"points\"\n", "embryo.file: is missing; set file to the table of points");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"nowhere.csv\"\n", "embryo.file: ");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"builtin:mouse\"\n",
         "table builtin:mouse does not exist; use one of: builtin:drosophila_atlas");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"a.csv\"\nscale = [1, 2]\n",
         "embryo.scale: has length 2; set scale to three");
  expect(egg + "belly_sag_um = 9\n", "embryo.belly_sag_um: requires back_sag_um; set both keys");
  expect(egg + "belly_sag_um = 60\nback_sag_um = 2\n", "embryo: ");
  expect(egg + "cells = [3, 3, 3]\n", "embryo.cells: is not used with shape \"egg\"");
  expect(egg + "elements = \"triangles\"\n", "embryo.elements: ");
  expect(egg + "least_edge_ratio = 0.9\n", "embryo.least_edge_ratio: ");
  expect(egg + "[region.r]\nface = \"ventral\"\n", "region.r.face: cells of this shape have no named faces");
  expect(egg + "[region.r]\narray = \"sna\"\n",
         "region.r.array: the embryo has no array \"sna\"; set embryo.cell_arrays to a table with this column");
  expect(egg + "[region.r]\nx_um = [-10, 10]\nabove = 2\n", "region.r.above: is not used without array");
  expect(egg + "[region.r]\nangle_deg = [170, 175]\nlength_percent = [0, 0.1]\n",
         "region.r: contains no cell of the embryo; change its selectors: cells lie at x -");
  expect(egg + "[contraction.c]\nregion = \"all\"\nedges = \"apical\"\nstiffness_nN_per_um = 1\ndiagonals = true\n",
         "contraction.c.diagonals: cell ");
  expect(egg + "[volume]\nmethod = \"projection\"\n",
         "test.toml:9: volume.method: the paper's algorithm supports four-sided cells only, but this tissue has "
         "polygonal cells; set method to \"coupled\" or \"none\"");
  expect(egg + "[time]\nscheme = \"linearly-implicit\"\n[volume]\nmethod = \"none\"\n",
         "test.toml:9: time.scheme: the paper's algorithm supports four-sided cells only");
}

const std::string periodic_sheet = sheet_table(60, 50, 10, 60);

std::unique_ptr<Model> model_of(const std::string& text) { return make_model(scenario_of(text)); }

TEST(PeriodicKeys, WhatDoesNotGoWithThemIsRefused) {
  const std::string both = periodic_sheet + "periodic = [\"x\", \"y\"]\n",
                    along = periodic_sheet + "periodic = [\"x\"]\n";
  const WrongScenarios cases = {
      {periodic_sheet + "periodic = [\"z\"]", "7: embryo.periodic: \"z\" is unknown; set periodic to a list of: x | y"},
      {periodic_sheet + "periodic = [\"x\", \"x\"]",
       "7: embryo.periodic: \"x\" occurs twice; list each direction once"},
      {"[embryo]\nshape = \"egg\"\nperiodic = [\"x\"]",
       "3: embryo.periodic: is not used with shape \"egg\"; remove periodic, or set shape to sheet"},
      {along + "curvature_per_um = [0.004, 0.004]",
       "8: embryo.curvature_per_um: a sheet curved along x cannot be periodic along x; set its curvature there to 0, "
       "or remove \"x\" from embryo.periodic"},
      {both + "rim = \"held\"",
       "8: embryo.rim: a sheet periodic along x and y has no boundary; remove rim, or one direction of "
       "embryo.periodic"},
      {along + "[division.a]\nregion = \"all\"\nat_s = 5",
       "7: embryo.periodic: cells of a periodic sheet cannot divide; remove periodic, or [division]"},
      {along + "mirror = [\"y\"]",
       "8: embryo.mirror: a periodic sheet cannot be reduced to one side; remove it, or embryo.periodic"},
      {along + "[volume]\nmethod = \"projection\"",
       "7: embryo.periodic: the paper's algorithm does not support periodic sheets; remove periodic, or set "
       "time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {both + "[enclosed.yolk]\nvolume = \"held\"",
       "8: enclosed.yolk: a sheet encloses no volume; remove the table, or set embryo.shape to \"pill\" or \"sphere\""},
  };
  expect_errors(cases, side_errors);
  const std::string few = side_errors(
      "[embryo]\nshape = \"sheet\"\nlength_um = 10\nwidth_um = 90\ncell_count = 20\ncell_height_um = 9\nperiodic = "
      "[\"x\"]");
  EXPECT_SAYS(few, "across the period; lengthen the period, or give more cells (about four along it)");
}

TEST(PeriodicKeys, ThePartsOfTheRimThatAreLeftAreHeld) {
  const auto model = model_of(periodic_sheet + "periodic = [\"x\"]\nrim = \"held\"");
  const Tissue& tissue = model->tissue;
  std::size_t held = 0;
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) {
    const bool is_at_rim = std::abs(tissue.rest_positions[n].y()) == 25;
    EXPECT_EQ(model->held[n], (std::array{is_at_rim, is_at_rim, is_at_rim})) << n;
    held += is_at_rim;
  }
  EXPECT_GT(held, 20U);
}

// A hold at the far end of a period fixes the periodic originals.
TEST(PeriodicKeys, AHoldOfAnImageHolds) {
  const auto model =
      model_of(periodic_sheet + "periodic = [\"x\", \"y\"]\n[hold.end]\nregion = \"all\"\nx_um = [30, 40]\n");
  std::size_t held = 0;
  for (std::size_t n = 0; n < model->tissue.free_node_count(); ++n)
    if (model->held[n][0]) {
      const double x = model->tissue.rest_positions[n].x();
      EXPECT_TRUE(x >= 30 - 1e-9 || x + 60 >= 30 - 1e-9) << x;
      held += x < 0;
    }
  EXPECT_GT(held, 4U);
}

TEST(PeriodicKeys, RegionsReachAcrossTheEnd) {
  const auto model =
      model_of(periodic_sheet +
               "periodic = [\"x\", \"y\"]\n[region.end]\nx_um = [24, 30]\n[region.beside]\nneighbours_of = \"end\"\n");
  const CellSet& beside = model->tissue.regions.at("beside");
  std::size_t far = 0;
  for (std::size_t c = 0; c < beside.size(); ++c)
    far += beside[c] && cell_centre(model->tissue.cells[c], model->tissue.rest_positions).x() < -20;
  EXPECT_GT(far, 3U);
}

}  // namespace
