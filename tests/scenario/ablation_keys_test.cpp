// Keys of [ablation.NAME]: effects on force laws, and messages.
#include <gtest/gtest.h>

#include <algorithm>

#include "mechanics/active/cortex.hpp"
#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

const std::string sheet = R"([embryo]
shape = "block"
length_um = 60
width_um = 20
cell_height_um = 20
cells = [3, 1, 1]
[vitelline]
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

Scenario loaded(const std::string& text) { return load_scenario({"test", "test.toml", text}); }

const Cortex& cortex_of(const Model& model, const std::string& name) {
  return dynamic_cast<const Cortex&>(
      **std::ranges::find_if(model.laws, [&](const auto& law) { return law->label() == "cortex." + name; }));
}

TEST(AblationKeys, FacesTimesAndRegionsAreThoseGiven) {
  const std::unique_ptr<Model> model = make_model(loaded(
      sheet + "[ablation.cut]\nregion = \"first\"\nfaces = [\"lateral\"]\nat_min = 1\nuntil_min = 3\nremaining = 0.5"));
  const Cortex &top = cortex_of(*model, "top"), &walls = cortex_of(*model, "walls");
  EXPECT_TRUE(top.pattern().ablations.empty());
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
      make_model(loaded(sheet + "[ablation.cut]\nregion = \"first\"\nonly = [\"cortex.top\"]\nat_s = 0"));
  EXPECT_TRUE(cortex_of(*other, "walls").pattern().ablations.empty());
  EXPECT_EQ(*cortex_of(*other, "top").activity_of(CellId(0), 1, {}), 0);

  const std::unique_ptr<Model> all =
      make_model(loaded(sheet + "[ablation.cut]\nregion = \"first\"\nonly = []\nat_s = 0"));
  EXPECT_EQ(*cortex_of(*all, "walls").activity_of(CellId(0), 1, {}), 0);
}

TEST(AblationKeys, WhatIsWrongIsSaid) {
  const auto cut = [](const std::string& keys) { return sheet + "[ablation.cut]\n" + keys; };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {cut("at_s = 5"), "test.toml:18: ablation.cut.region: is missing; set region to a text"},
      {cut("region = \"second\"\nat_s = 5"),
       "test.toml:19: ablation.cut.region: region \"second\" does not exist; use one of"},
      {cut("region = \"first\""), "test.toml:18: ablation.cut: no start time; set at_min or at_s (0 = from the start)"},
      {cut("region = \"first\"\nat_s = -5"),
       "test.toml:20: ablation.cut.at_s: -5 is out of range; set at_s to a number >= 0"},
      {cut("region = \"first\"\nat_s = 5\nat_min = 1"),
       "conflicts with ablation.cut.at_min, which is also set; remove one of them"},
      {cut("region = \"first\"\nat_min = 5\nuntil_min = 5"),
       "test.toml:21: ablation.cut.until_min: is not after the start of the ablation; set a later time, or \"none\""},
      {cut("region = \"first\"\nat_s = 5\nremaining = 1.5"),
       "test.toml:21: ablation.cut.remaining: 1.5 is out of range; set remaining to a number, 0 to 1"},
      {cut("region = \"first\"\nat_s = 5\nfaces = []"), "test.toml:21: ablation.cut.faces: the list is empty"},
      {cut("region = \"first\"\nat_s = 5\nfaces = [\"top\"]"), "test.toml:21: ablation.cut.faces: \"top\" is unknown"},
      {cut("region = \"first\"\nat_s = 5\nonly = [\"cortex.tip\"]"),
       "test.toml:21: ablation.cut.only: [cortex.tip] does not exist; use \"cortex.top\" (nearest match)"},
      {cut("region = \"first\"\nat_s = 5\nface = \"apical\""),
       "test.toml:21: ablation.cut.face: unknown key; use \"faces\""},
  };
  for (const auto& [text, message] : cases) try {
      (void)loaded(text);
      ADD_FAILURE() << message;
    } catch (const ScenarioError& error) {
      EXPECT_NE(error.diagnostics().front().text().find(message), std::string::npos)
          << error.diagnostics().front().text();
    }
}

TEST(AblationKeys, WhatTakesNothingIsTold) {
  const auto advice_on = [](const std::string& keys) {
    const Scenario scenario = loaded(sheet + "[time]\nend_s = 60\n[ablation.cut]\nregion = \"first\"\n" + keys);
    std::string lines;
    for (const std::string& line : advice(scenario, *make_model(scenario)))
      if (line.find("ablation") != std::string::npos) lines += line;
    return lines;
  };
  EXPECT_EQ(advice_on("at_s = 5"), "");
  EXPECT_EQ(advice_on("at_s = 5\nonly = [\"cortex.walls\"]"), "");
  EXPECT_NE(advice_on("at_s = 5\nonly = [\"cortex.walls\"]\nfaces = [\"apical\"]"), "");
  EXPECT_EQ(advice_on("at_s = 5\n[monitor.ablation]\nquantity = \"time\"\nat_s = 60"), "");
  EXPECT_EQ(advice_on("at_s = 5\n[monitor.ablation]\nquantity = \"time\"\nat_s = 61"),
            "warning: monitor.ablation: at_s is after the end of the run (60 s); change at_s or time.end_s");
  EXPECT_EQ(advice_on("at_s = 60"),
            "warning: ablation.cut: the ablation starts after the end of the run (60 s); change at_s or time.end_s");
  EXPECT_EQ(advice_on("at_s = 5\nfaces = [\"basal\"]"),
            "warning: ablation.cut: has no effect, since no selected cortex or contraction acts on these faces in "
            "region first; change faces, only or region");
}

}  // namespace
}  // namespace plica
