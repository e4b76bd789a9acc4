// Keys of patterns, of cell arrays and of [ablation.NAME].
#include "core/files.hpp"
#include "mechanics/active/contraction.hpp"
#include "mechanics/active/cortex.hpp"
#include "scenario/acting.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "simulation/controls.hpp"
#include "support/own_folder.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"

namespace {

TEST(PatternKeys, RegionsByRowsAndNeighbours) {
  const Tissue tissue = make_tissue(load_scenario(
      {"test", "test.toml",
       egg + "[region.mesoderm]\nrows = 5\nlength_percent = [20, 80]\n[region.mesectoderm]\nneighbours_of = "
             "\"mesoderm\"\n[region.side]\nneighbours_of = \"mesoderm\"\nrings = 3\nexcept = "
             "[\"mesectoderm\"]\n[region.right]\nneighbours_of = \"mesoderm\"\ny_um = [0, 100]\n"}));
  const std::vector<int> halves = half_cells_from_midline(tissue);
  const CellSet &mesoderm = tissue.regions.at("mesoderm"), &beside = tissue.regions.at("mesectoderm"),
                &side = tissue.regions.at("side"), &right = tissue.regions.at("right");
  const CellSet around = cells_around(tissue, mesoderm, 1), far = cells_around(tissue, mesoderm, 3);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Vec3 centre = cell_centre(tissue.cells[c], tissue.rest_positions);
    const bool is_long = centre.x() >= -75 && centre.x() <= 75;
    if (std::abs(std::abs(centre.x()) - 75) > 1) {
      EXPECT_EQ(mesoderm[c], halves[c] < 5 && is_long) << c;
    }
    EXPECT_EQ(beside[c], around[c]);
    EXPECT_EQ(side[c], far[c] && !around[c]);
    EXPECT_EQ(right[c], around[c] && centre.y() >= 0);
  }
  EXPECT_GT(std::ranges::count(side, true), std::ranges::count(beside, true));
}

TEST(PatternKeys, ProfilesOfAScenario) {
  const Scenario scenario = load_scenario(
      {"test", "test.toml",
       egg + "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\nprofile = { shape = \"gaussian\", axis = "
             "\"angle\", sigma_deg = 20 }\n[cortex.b]\nregion = \"all\"\ntension_mN_per_m = 1\nprofile = { shape = "
             "\"table\", axis = \"angle\", at_deg = [-90, 0, 90], factor = [0, 1, 0.5] }\npulse = { period_min = 1.5, "
             "amplitude = 0.5, seed = 7 }\n[pressure.c]\nregion = \"all\"\npressure_Pa = 10\nprofile = { shape = "
             "\"table\", axis = \"along\", at_um = [0, 100], factor = [1, 0.2] }\n[elasticity.d]\nregion = "
             "\"all\"\nprofile = { shape = \"linear\", axis = \"along\", half_width_um = 100, edge = 0.5 }\n"});
  const Tissue tissue = make_tissue(scenario);
  const CellPattern a = make_pattern(scenario.contractions.at("a"), tissue),
                    b = make_pattern(scenario.cortices.at("b"), tissue),
                    c = make_pattern(scenario.pressures.at("c"), tissue),
                    d = make_pattern(scenario.region_elasticities.at("d"), tissue);
  for (std::size_t k = 0; k < tissue.cells.size(); ++k) {
    const Vec3 x = cell_centre(tissue.cells[k], tissue.rest_positions);
    const double angle = std::atan2(x.y(), -x.z()) * 180 / M_PI;
    EXPECT_NEAR(a.strengths[k], std::exp(-angle * angle / 800), 1e-9);
    const double table = angle < -90 ? 0 : angle < 0 ? 1 + angle / 90 : angle < 90 ? 1 - angle / 180 : 0.5;
    EXPECT_NEAR(b.strengths[k], table, 1e-9);
    // The middle lies between the outermost centres, near x = 0.
    EXPECT_NEAR(c.strengths[k], 1 - 0.8 * std::min(1.0, std::abs(x.x()) / 100), 0.03);
    EXPECT_NEAR(d.strengths[k], 1 - 0.5 * std::min(1.0, std::abs(x.x()) / 100), 0.03);
    EXPECT_EQ(b.pulse_periods_s[k], 90);
  }
  EXPECT_EQ(make_controls(scenario).max_step_s, 7.5);
  EXPECT_GE(make_controls(scenario).program_points_s.back(), scenario.time.end_s);
  // The printed scenario reads back as the same.
  const std::string printed = resolved_toml(scenario);
  EXPECT_EQ(resolved_toml(scenario_of(printed)), printed);
}

using PatternFiles = OwnFolder;

TEST_F(PatternFiles, ProfilesByAnArray) {
  write_file(folder / "points.csv", numbered_points("twi"));
  const std::string points = "format = 1\n[embryo]\nshape = \"points\"\nfile = \"points.csv\"\ncell_height_um = 15\n";
  const std::string act = "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\nprofile = ";
  const auto load = [&](const std::string& profile) {
    return load_scenario({"test", (folder / "test.toml").string(), points + act + profile + "\n"});
  };
  const Scenario scenario = load("{ shape = \"array\", array = \"twi\", from = 20, to = 120, middle = 2 }");
  const auto model = make_model(scenario);
  const CellPattern found = make_pattern(scenario.contractions.at("a"), model->tissue);
  for (int c = 0; c < 200; ++c) EXPECT_NEAR(found.strengths[c], 2 * std::clamp((c - 20) / 100.0, 0.0, 1.0), 1e-12);
  const auto lines_of = [&](const std::string& profile) {
    const Scenario other = load(profile);
    return advice(other, *make_model(other));
  };
  const std::string nothing =
      "warning: contraction.a: profile is 0 in every cell of region all (twi ranges from 0 to 199 there); change "
      "profile";
  EXPECT_EQ(std::ranges::count(lines_of("{ shape = \"array\", array = \"twi\", from = 300, to = 400 }"), nothing), 1);
  EXPECT_EQ(std::ranges::count(lines_of("{ shape = \"array\", array = \"twi\", from = 100, to = 400 }"), nothing), 0);
  const std::string errors =
      errors_in([&] { return make_model(load("{ shape = \"array\", array = \"sna\", from = 0, to = 1 }")); });
  EXPECT_SAYS(errors,
              "test.toml:9: contraction.a.profile.array: the embryo has no array \"sna\"; set array to one of: twi");
}

// Messages contain line, key and remedy.
TEST(PatternKeys, WhatIsWrongIsSaidWithItsKey) {
  const auto expect = [&](const std::string& text, const std::string& said) {
    EXPECT_SAYS(model_errors(egg + text), said);
  };
  const auto act = [](const std::string& more) {
    return "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\n" + more + "\n";
  };
  expect("[region.r]\nneighbours_of = \"belly\"\n",
         "test.toml:9: region.r.neighbours_of: region \"belly\" does not exist");
  expect("[region.r]\nneighbours_of = \"r\"\n", "region.r: refers to itself: r > r; remove one of these references");
  expect("[region.a]\nneighbours_of = \"b\"\n[region.b]\nunion = [\"a\"]\n", "region.a: refers to itself: a > b > a");
  expect("[region.r]\nneighbours_of = \"all\"\n", "region.r: contains no cell of the embryo");
  expect("[region.r]\nrows = 3\nrings = 2\n",
         "test.toml:10: region.r.rings: is not used without neighbours_of; set neighbours_of to the region");
  expect(act("profile = { shape = \"array\", from = 0, to = 1 }"),
         "test.toml:11: contraction.a.profile.array: is missing; set array to a cell array");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 0, to = 1 }"),
         "contraction.a.profile.array: the embryo has no array \"twi\"; set embryo.cell_arrays to a table");
  expect(act("profile = { shape = \"array\", array = \"twi\", to = 1 }"),
         "contraction.a.profile.from: is missing; set `from`");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 1, to = 1 }"),
         "contraction.a.profile.to: equals `from`; set `to` to a different value");
  expect(act("profile = { shape = \"gaussian\", sigma_um = 9, array = \"twi\" }"),
         "contraction.a.profile.array: is not used with shape \"gaussian\"; remove it, or set shape to \"array\"");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 0, to = 1, axis = \"along\" }"),
         "contraction.a.profile.axis: is not used with shape \"array\"; remove axis");
  expect(
      act("profile = { shape = \"gaussian\", axis = \"angle\", sigma_um = 9 }"),
      "contraction.a.profile.sigma_um: is not used with axis \"angle\"; use the key in degrees, or set another axis");
  expect(act("profile = { shape = \"gaussian\", axis = \"angle\" }"),
         "contraction.a.profile.sigma_deg: is missing; set sigma_deg to a number > 0");
  expect(
      act("profile = { shape = \"plateau\", sigma_deg = 4, full_cells = 3, fade_cells = 1 }"),
      "contraction.a.profile.sigma_deg: is not used with shape \"plateau\"; remove it, or set shape to \"gaussian\"");
  expect(
      act("profile = { shape = \"linear\", half_width_deg = 4, half_width_um = 3 }"),
      "contraction.a.profile.half_width_deg: is not used with axis \"across\"; use a length, or set axis to \"angle\"");
  expect(act("profile = { shape = \"linear\", half_width_um = 3, centre_deg = 4 }"),
         "contraction.a.profile.centre_deg: requires axis \"angle\"; remove centre_deg, or set axis to \"angle\"");
  expect(act("profile = { shape = \"linear\", axis = \"angle\", half_width_deg = 3, about = \"all\" }"),
         "contraction.a.profile.about: is not used with axis \"angle\"; remove about; centre_deg sets");
  expect(act("profile = { sigma_deg = 4 }"),
         "contraction.a.profile.shape: is missing; set shape to one of: constant | linear");
  expect(act("profile = { shape = \"table\", factor = [1, 0] }"),
         "contraction.a.profile.at_um: is missing; set at_um or at_cells");
  expect(act("profile = { shape = \"table\", at_um = [1, 2] }"),
         "contraction.a.profile.factor: is missing; set factor to one value");
  expect(act("profile = { shape = \"table\", at_um = [0, 20, 10], factor = [1, 0, 0] }"),
         "contraction.a.profile.at_um: the positions do not increase; list positions in increasing order");
  expect(act("profile = { shape = \"table\", at_um = [0, 20, 30], factor = [1, 0] }"),
         "contraction.a.profile.factor: has length 2 for 3 positions; set factor to as many values as positions");
  expect(act("profile = { shape = \"table\", at_um = [0, 20], at_cells = [0, 2], factor = [1, 0] }"),
         "profile.at_um: conflicts with contraction.a.profile.at_cells, which is also set; remove one of them");
  expect(act("profile = { shape = \"table\", at_um = [0, 20], factor = [1, 0], middle = 2 }"),
         "contraction.a.profile.middle: is not used with shape \"table\"; remove it");
  expect(act("pulse = { amplitude = 0.5 }"), "test.toml:11: contraction.a.pulse.period_s: is missing; set period_s");
  expect(
      act("pulse = { period_s = 60 }\n[time]\nstep_s = 10"),
      "contraction.a.pulse.period_s: time steps of 10 s do not resolve a period of 60 s; set time.step_s to at most 5");
}

const std::string block =
    "[embryo]\nshape = \"block\"\nlength_um = 40\nwidth_um = 40\ncells = [2, 2, 1]\ncell_arrays = "
    "\"plica_arrays.csv\"\n[vitelline]\nenabled = false\n";

class CellArrays : public OwnFolder {
 protected:
  [[nodiscard]] Scenario load(const std::string& table, const std::string& more = "") const {
    write("plica_arrays.csv", table);
    return load_scenario({"block", (folder / "block.toml").string(), block + more});
  }
  [[nodiscard]] static std::string errors_of(const Scenario& scenario) {
    return errors_in([&] { return make_model(scenario); });
  }
};

TEST_F(CellArrays, OfATableSelectAndGradeCells) {
  const Scenario scenario =
      load("myosin\n0\n1\n0.5\n0\n",
           "[region.active]\narray = \"myosin\"\n[contraction.apical]\nregion = \"active\"\nstiffness_nN_per_um = "
           "1\nprofile = { shape = \"array\", array = \"myosin\", from = 0, to = 1 }\n");
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
  EXPECT_SAYS(errors_of(load("myosin\n0\n1\n")), "embryo.cell_arrays: ");
  EXPECT_SAYS(errors_of(load("myosin\n0\n1\n")), "has 2 values for 4 cells; give one per cell");
  Scenario scenario = load("myosin\n0\n1\n2\n3\n");
  scenario.embryo.arrays = {{"calcium", {1}}};
  EXPECT_SAYS(errors_of(scenario), "an array given has 1 values for 4 cells");
  EXPECT_SAYS(errors_of(load("myosin\nmuch\n")), "\"much\" of column myosin is not a number");
}

const std::string layered_block = block_table(60, 20, 20, "3, 1, 1") + R"([vitelline]
enabled = false
[region.first]
x_um = [-30, -10]
[cortex.top]
region = "all"
tension_mN_per_m = 2
[cortex.walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 2
)";

const Cortex& cortex_of(const Model& model, const std::string& name) {
  return dynamic_cast<const Cortex&>(
      **std::ranges::find_if(model.laws, [&](const auto& law) { return law->label() == "cortex." + name; }));
}

TEST(AblationKeys, FacesTimesAndRegionsAreThoseGiven) {
  const std::unique_ptr<Model> model = make_model(scenario_of(
      layered_block +
      "[ablation.cut]\nregion = \"first\"\nfaces = [\"lateral\"]\nat_min = 1\nuntil_min = 3\nremaining = 0.5"));
  const Cortex &top = cortex_of(*model, "top"), &walls = cortex_of(*model, "walls");
  EXPECT_TRUE(top.pattern()->ablations.empty());
  for (const auto& [time_s, first] : {std::pair(60.0, 1.0), {61.0, 0.5}, {180.0, 0.5}, {181.0, 1.0}}) {
    EXPECT_EQ(*top.activity_of(CellId(0), time_s, {}), 1);
    EXPECT_EQ(*walls.activity_of(CellId(0), time_s, {}), first) << time_s;
    EXPECT_EQ(*walls.activity_of(CellId(1), time_s, {}), 1);
  }
  // A lateral face between an ablated and an intact cell keeps the intact half, and here half of the ablated half.
  Step step;
  step.positions = step.previous_positions = model->tissue.rest_positions;
  step.end_time_s = 100;
  const std::vector<double> tensions = walls.tensions(step);
  for (std::size_t f = 0; f < tensions.size(); ++f) {
    const Face& face = walls.faces()[f];
    const auto of_cell = [](CellId cell) { return cell.number() == 0 ? 1.0 : 2.0; };
    EXPECT_DOUBLE_EQ(tensions[f],
                     face.beyond ? 0.5 * (of_cell(face.cell) + of_cell(*face.beyond)) : of_cell(face.cell));
  }
  EXPECT_EQ(walls.program_jumps_s().back(), 180);

  const std::unique_ptr<Model> other =
      make_model(scenario_of(layered_block + "[ablation.cut]\nregion = \"first\"\nonly = [\"cortex.top\"]\nat_s = 0"));
  EXPECT_TRUE(cortex_of(*other, "walls").pattern()->ablations.empty());
  EXPECT_EQ(*cortex_of(*other, "top").activity_of(CellId(0), 1, {}), 0);

  const std::unique_ptr<Model> all =
      make_model(scenario_of(layered_block + "[ablation.cut]\nregion = \"first\"\nonly = []\nat_s = 0"));
  EXPECT_EQ(*cortex_of(*all, "walls").activity_of(CellId(0), 1, {}), 0);
}

// Of walls of three elements, only the middle ones lose their tension; no cell as a whole does.
TEST(AblationKeys, CutAtAHeight) {
  const std::string three_high =
      std::regex_replace(layered_block, std::regex("cells = "), "elements_per_cell = [1, 1, 3]\ncells = ");
  const std::string cut = "[ablation.cut]\nregion = \"all\"\nfaces = [\"lateral\"]\nat_min = 1\nheight_percent = ";
  const std::unique_ptr<Model> model = make_model(scenario_of(three_high + cut + "[40, 60]"));
  const Cortex& walls = cortex_of(*model, "walls");
  Step step;
  step.positions = step.previous_positions = model->tissue.rest_positions;
  step.end_time_s = 100;
  const std::vector<double> tensions = walls.tensions(step);
  std::map<long, int> of_height;
  for (std::size_t f = 0; f < tensions.size(); ++f) {
    const Face& face = walls.faces()[f];
    const long height = std::lround(height_percent(model->tissue, face.cell, face.nodes));
    ++of_height[height];
    EXPECT_EQ(tensions[f], height == 50 ? 0 : 2) << height;
  }
  EXPECT_EQ(of_height.size(), 3U);
  EXPECT_EQ(*walls.activity_of(CellId(0), 100, {}), 1);
  EXPECT_SAYS(model_errors(three_high + cut + "[0, 10]"), "no lateral face of the region has its centre in this part");
  EXPECT_SAYS(model_errors(layered_block + cut + "[40, 60]"), "every lateral face of the region has its centre");
}

TEST(AblationKeys, WhatIsWrongIsSaid) {
  const auto cut = [](const std::string& keys) { return layered_block + "[ablation.cut]\n" + keys; };
  const WrongScenarios cases = {
      {cut("at_s = 5"),
       "test.toml:18: ablation.cut.region: is missing; set region to \"all\", or to the name of another region"},
      {cut("region = \"second\"\nat_s = 5"),
       "test.toml:19: ablation.cut.region: region \"second\" does not exist; use one of"},
      {cut("region = \"first\""), "test.toml:18: ablation.cut: no start time; set at_min or at_s (0 = from the start)"},
      {cut("region = \"first\"\nat_s = 5\nat_min = 1"),
       "conflicts with ablation.cut.at_min, which is also set; remove one of them"},
      {cut("region = \"first\"\nat_min = 5\nuntil_min = 5"),
       "test.toml:21: ablation.cut.until_min: is not after the start of the ablation; set a later time, or \"none\""},
      {cut("region = \"first\"\nat_s = 5\nrecovery_s = 5"),
       "test.toml:21: ablation.cut.recovery_s: is not used without until_s, the time at which recovery begins; set "
       "until_min, or remove it"},
      {cut("region = \"first\"\nat_s = 5\nheight_percent = [40, 60]"),
       "test.toml:21: ablation.cut.height_percent: acts on lateral faces only; set faces to [\"lateral\"]"},
      {cut("region = \"first\"\nat_s = 5\nfaces = [\"lateral\"]\nheight_percent = [40, 60]\n[contraction.rods]\nregion "
           "= \"all\"\nedges = \"lateral\"\npreload_nN = 1"),
       "test.toml:22: ablation.cut.height_percent: [contraction.rods] acts along whole lateral edges; name the "
       "cortices "
       "to cut in `only`"},
      {cut("region = \"first\"\nat_s = 5\nonly = [\"cortex.tip\"]"),
       "test.toml:21: ablation.cut.only: [cortex.tip] does not exist; use \"cortex.top\" (nearest match)"},
  };
  for (const auto& [text, message] : cases) EXPECT_SAYS(load_errors(text), message);
}

TEST(AblationKeys, WhatTakesNothingIsTold) {
  const auto advice_on = [](const std::string& keys) {
    const Scenario scenario =
        scenario_of(layered_block + "[time]\nend_s = 60\n[ablation.cut]\nregion = \"first\"\n" + keys);
    std::string lines;
    for (const std::string& line : advice(scenario, *make_model(scenario)))
      if (line.find("ablation") != std::string::npos) lines += line;
    return lines;
  };
  EXPECT_EQ(advice_on("at_s = 5"), "");
  EXPECT_EQ(advice_on("at_s = 5\nonly = [\"cortex.walls\"]"), "");
  EXPECT_NE(advice_on("at_s = 5\nonly = [\"cortex.walls\"]\nfaces = [\"apical\"]"), "");
  EXPECT_EQ(advice_on("at_s = 5\nfaces = [\"basal\"]"),
            "warning: ablation.cut: has no effect, since no selected cortex or contraction acts on these faces in "
            "region first; change faces, only or region");
}

}  // namespace
