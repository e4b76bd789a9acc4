// The furrow's depth and lips; columns of results, and the sets that a scenario measures.
#include "measure/furrow.hpp"

#include "measure/cell_columns.hpp"
#include "measure/cells.hpp"
#include "measure/columns.hpp"
#include "measure/measure_set.hpp"
#include "measure/observation.hpp"
#include "record/csv.hpp"
#include "record/summary.hpp"
#include "simulation/simulation.hpp"
#include "support/prisms.hpp"
#include "support/scenarios.hpp"

namespace {

/// The paper's Drosophila, its 14 x 5 contractile ventral cells, and what is measured of them.
struct Pill {
  Tissue tissue = build_shell({});
  CellSet contractile = CellSet(tissue.cells.size());
  FurrowSites sites;

  explicit Pill(int vce_from_end = 2) {
    for (std::size_t c = 0; c < contractile.size(); ++c) {
      const GridPlace& place = *tissue.cells[c].grid_place;
      contractile[c] = place.face == GridPlace::Face::ventral && 2 <= place.place[0] && place.place[0] < 16 &&
                       2 <= place.place[1] && place.place[1] < 7;
    }
    sites = choose_furrow_sites(tissue, contractile, vce_from_end);
  }

  /// Columns and rows of cells on the ventral face.
  [[nodiscard]] std::set<std::array<int, 2>> places(const std::vector<CellId>& cells) const {
    std::set<std::array<int, 2>> result;
    for (const CellId cell : cells) {
      const GridPlace& place = *tissue.cells[cell.index()].grid_place;
      EXPECT_EQ(place.face, GridPlace::Face::ventral);
      result.insert(place.place);
    }
    return result;
  }

  /// Positions at rest, the nodes of some cells shifted.
  [[nodiscard]] Vectors shifted(const std::vector<CellId>& cells, const Vec3& shift) const {
    Vectors positions = tissue.rest_positions;
    std::set<NodeId> nodes;
    for (const CellId cell : cells)
      for (const NodeId node : tissue.cells[cell.index()].corners) nodes.insert(node);
    for (const NodeId node : nodes) positions[node.index()] += shift;
    return positions;
  }

  [[nodiscard]] std::vector<CellId> contractile_cells() const {
    std::vector<CellId> cells;
    for (std::size_t c = 0; c < contractile.size(); ++c)
      if (contractile[c]) cells.emplace_back(c);
    return cells;
  }
};

using Places = std::set<std::array<int, 2>>;

TEST(Furrow, MonitoredCellsAreAtTheMiddleAndSecondLastOnTheMidline) {
  const Pill pill;
  EXPECT_EQ(pill.contractile_cells().size(), 70u);
  EXPECT_EQ(pill.sites.midline_pairs, 7);
  ASSERT_EQ(pill.sites.vml.size(), 2u);
  ASSERT_EQ(pill.sites.vce.size(), 2u);
  EXPECT_EQ(pill.places(pill.sites.vml), (Places{{8, 4}, {9, 4}}));
  EXPECT_EQ(pill.places(pill.sites.vce), (Places{{3, 4}, {14, 4}}));
}

TEST(Furrow, EndCellsAreCountedFromTheEndsAndStopAtTheMiddle) {
  for (const auto& [from_end, column] : {std::pair{1, 2}, {2, 3}, {7, 8}, {8, 8}, {100, 8}}) {
    const Pill pill(from_end);
    EXPECT_EQ(pill.places(pill.sites.vce), (Places{{column, 4}, {17 - column, 4}})) << from_end << " from the end";
  }
}

TEST(Furrow, MidlineRunsFromAnteriorToPosterior) {
  const Pill pill;
  double before = -1e300;
  int ventral = 0;
  for (const CellId cell : pill.sites.midline) {
    const Vec3 centre = cell_centre(pill.tissue.cells[cell.index()], pill.tissue.rest_positions);
    EXPECT_GT(centre.x(), before);
    EXPECT_NEAR(centre.y(), 0, 1e-9);
    EXPECT_LT(centre.z(), 0);
    before = centre.x();
    ventral += pill.tissue.cells[cell.index()].grid_place->face == GridPlace::Face::ventral;
  }
  EXPECT_EQ(ventral, 18);
}

TEST(Furrow, LipsAreTheEdgeOfTheRegionInTheMiddle) {
  const Pill pill;
  ASSERT_TRUE(pill.sites.has_lips);
  const Vectors& rest = pill.tissue.rest_positions;
  // The outermost nodes of the region on x = 0.
  double edge_y = 0, edge_z = 0;
  for (const CellId cell : pill.contractile_cells())
    for (int corner = 4; corner < 8; ++corner) {
      const Vec3& x = rest[pill.tissue.cells[cell.index()].corners[corner].index()];
      if (x.x() == 0 && std::abs(x.y()) > edge_y) edge_y = std::abs(x.y()), edge_z = x.z();
    }
  ASSERT_GT(edge_y, 0);
  const Vec3 left = pill.sites.lips[0].at(rest), right = pill.sites.lips[1].at(rest);
  EXPECT_LE((left - Vec3(0, -edge_y, edge_z)).norm(), 1e-12);
  EXPECT_LE((right - Vec3(0, edge_y, edge_z)).norm(), 1e-12);
  EXPECT_NEAR(lip_shape(pill.tissue, pill.sites, rest).lip_distance_um.value(), 2 * edge_y, 1e-12);
}

TEST(Furrow, AtRestThereIsNone) {
  const Pill pill;
  const LipShape shape = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, pill.tissue.rest_positions).value(), 0, 1e-12);
  EXPECT_LT(shape.depth_below_lips_um.value(), 0) << "the belly is convex";
  for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.midline, pill.tissue.rest_positions))
    EXPECT_NEAR(depth.value(), 0, 1e-12);
}

TEST(Furrow, DepthIsTheShiftOfTheMiddle) {
  const Pill pill;
  const LipShape rest = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  for (const double shift : {0.5, 7.0, 31.0}) {
    const Vectors positions = pill.shifted(pill.sites.vml, Vec3(0, 0, shift));
    const LipShape shape = lip_shape(pill.tissue, pill.sites, positions);
    EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, positions).value(), shift, 1e-10);
    EXPECT_NEAR(shape.depth_below_lips_um.value(), rest.depth_below_lips_um.value() + shift, 1e-10);
    EXPECT_NEAR(shape.lip_distance_um.value(), rest.lip_distance_um.value(), 1e-12);
    for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.vml, positions))
      EXPECT_NEAR(depth.value(), shift, 1e-10);
    for (const auto& depth : cell_depths_um(pill.tissue, pill.sites, pill.sites.vce, positions))
      EXPECT_NEAR(depth.value(), 0, 1e-12);
  }
}

// A dimple of single faces is no furrow: the middles of polygons move and depth does not, but their corners count.
TEST(Furrow, DepthIsWithoutDimples) {
  const Tissue tissue = tissue_from_prisms(honeycomb(5, 5, 6, 12), PolygonSplit::kites, 1);
  const CellSet all(tissue.cells.size(), true);
  const FurrowSites sites = choose_furrow_sites(tissue, all, 2);
  Vectors dimpled = tissue.rest_positions, lowered = tissue.rest_positions;
  int middles = 0;
  for (const Cell& cell : tissue.cells) {
    const Vec3 middle = mean_apical(cell, tissue.rest_positions);
    for (std::size_t n = 0; n < tissue.node_count(); ++n)
      if ((tissue.rest_positions[n] - middle).norm() < 1e-9) dimpled[n].z() -= 2, ++middles;
  }
  for (Vec3& x : lowered) x.z() -= 3;
  EXPECT_EQ(middles, 25);
  const LipShape rest = lip_shape(tissue, sites, tissue.rest_positions);
  const LipShape shape = lip_shape(tissue, sites, dimpled);
  EXPECT_NEAR(furrow_depth_um(tissue, sites, dimpled).value(), 0, 1e-12);
  EXPECT_NEAR(shape.depth_below_lips_um.value(), rest.depth_below_lips_um.value(), 1e-12);
  for (const auto& depth : cell_depths_um(tissue, sites, sites.midline, dimpled)) EXPECT_NEAR(depth.value(), 0, 1e-12);
  EXPECT_NEAR(furrow_depth_um(tissue, sites, lowered).value(), 3, 1e-12);
}

// Walls of a closed furrow cross the middle plane by a little; its bottom is below them.
TEST(Furrow, BottomOfAClosedFurrow) {
  const Tissue sheet = build_block({90, 90, 10, {9, 9, 1}, {1, 1, 1}});
  CellSet middle(sheet.cells.size());
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = std::abs(cell_centre(sheet.cells[c], sheet.rest_positions).y()) < 35;
  const FurrowSites sites = choose_furrow_sites(sheet, middle, 1);
  Vectors closed = sheet.rest_positions;
  for (Vec3& x : closed) {
    const double from_middle = std::abs(x.y()), side = std::copysign(1.0, x.y());
    if (from_middle > 10) x.y() = side * (from_middle > 20 ? 1 + from_middle - 25 : -0.5);
    x.z() += std::min(from_middle, 35.0) - 35;
  }
  EXPECT_NEAR(lip_shape(sheet, sites, closed).depth_below_lips_um.value(), 30, 1e-10);
}

TEST(Furrow, LipsMoveWithTheTissue) {
  const Pill pill;
  const LipShape rest = lip_shape(pill.tissue, pill.sites, pill.tissue.rest_positions);
  // All contractile cells rise: as deep inside the shell, no deeper below the lips.
  const Vectors risen = pill.shifted(pill.contractile_cells(), Vec3(0, 0, 9));
  const LipShape raised = lip_shape(pill.tissue, pill.sites, risen);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, pill.sites, risen).value(), 9, 1e-10);
  EXPECT_NEAR(raised.depth_below_lips_um.value(), rest.depth_below_lips_um.value(), 1e-10);
  EXPECT_NEAR(raised.lip_distance_um.value(), rest.lip_distance_um.value(), 1e-12);
  // Every width narrows by a tenth, and the lips' distance does.
  Vectors narrow = pill.tissue.rest_positions;
  for (Vec3& x : narrow) x.y() *= 0.9;
  EXPECT_NEAR(lip_shape(pill.tissue, pill.sites, narrow).lip_distance_um.value(), 0.9 * *rest.lip_distance_um, 1e-12);
}

TEST(Furrow, WithoutContractileCellsNothingHasAValue) {
  const Tissue tissue = build_shell({});
  const FurrowSites sites = choose_furrow_sites(tissue, CellSet(tissue.cells.size()), 2);
  EXPECT_TRUE(sites.vml.empty());
  EXPECT_TRUE(sites.vce.empty());
  EXPECT_FALSE(sites.has_lips);
  const LipShape shape = lip_shape(tissue, sites, tissue.rest_positions);
  EXPECT_FALSE(furrow_depth_um(tissue, sites, tissue.rest_positions));
  EXPECT_FALSE(shape.depth_below_lips_um || shape.lip_distance_um || shape.highest_points_distance_um);
}

// Whatever side of an embryo, or of a sheet, the apices of the region face: inward is against them.
TEST(Furrow, DepthIsAgainstTheRegionsApices) {
  const Pill pill;
  CellSet dorsal(pill.contractile.size());
  for (std::size_t c = 0; c < dorsal.size(); ++c) {
    const GridPlace& place = *pill.tissue.cells[c].grid_place;
    dorsal[c] = place.face == GridPlace::Face::dorsal && 6 <= place.place[0] && place.place[0] < 12 &&
                2 <= place.place[1] && place.place[1] < 7;
  }
  const FurrowSites sites = choose_furrow_sites(pill.tissue, dorsal, 1);
  EXPECT_EQ(sites.outward, Vec3::UnitZ());
  const Vectors positions = pill.shifted(sites.vml, Vec3(0, 0, -7));
  const LipShape shape = lip_shape(pill.tissue, sites, positions);
  EXPECT_NEAR(furrow_depth_um(pill.tissue, sites, positions).value(), 7, 1e-10);
  EXPECT_NEAR(shape.depth_below_lips_um.value(),
              7 + lip_shape(pill.tissue, sites, pill.tissue.rest_positions).depth_below_lips_um.value(), 1e-10);

  const Tissue block = build_block({90, 90, 10, {9, 9, 1}, {1, 1, 1}});
  CellSet middle(block.cells.size());
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = cell_centre(block.cells[c], block.rest_positions).norm() < 25;
  const FurrowSites sheet = choose_furrow_sites(block, middle, 1);
  EXPECT_EQ(sheet.outward, Vec3::UnitZ());
  EXPECT_EQ(sheet.midline.size(), 9u);
  Vectors bent = block.rest_positions;
  for (Vec3& x : bent)
    if (Eigen::Vector2d(x.x(), x.y()).norm() < 10) x.z() -= 16.86;
  EXPECT_NEAR(furrow_depth_um(block, sheet, bent).value(), 16.86, 1e-10);
  EXPECT_GT(lip_shape(block, sheet, bent).depth_below_lips_um.value(), 5);
}

// A furrow that is deepest in the middle is straight; one that goes up and down by 3 um is wavy by 3 / sqrt(2).
TEST(Furrow, WavinessIsWhatASmoothFloorLeaves) {
  const Tissue block = build_block({400, 90, 10, {80, 9, 1}, {1, 1, 1}});
  CellSet middle(block.cells.size());
  for (std::size_t c = 0; c < middle.size(); ++c)
    middle[c] = std::abs(cell_centre(block.cells[c], block.rest_positions).x()) < 160;  // 64 cells, of which 32 count
  const FurrowSites sites = choose_furrow_sites(block, middle, 1);
  const auto waviness = [&](const auto& depth) {
    Vectors positions = block.rest_positions;
    for (Vec3& x : positions) x.z() -= depth(x.x());
    return midline_waviness_um(block, sites, positions);
  };
  const auto dome = [](double x) { return 40 - 1e-3 * x * x + 1e-8 * std::pow(x, 4) + 0.02 * x; };
  EXPECT_NEAR(waviness(dome).value(), 0, 1e-10);
  const auto waves = [&](double x) { return dome(x) + 3 * std::cos(2 * std::numbers::pi * x / 20); };
  // A cell's apex, 5 um long, has the mean of its ends.
  EXPECT_NEAR(waviness(waves).value(), 3 * std::cos(std::numbers::pi * 5 / 20) / std::sqrt(2), 0.05);

  CellSet few = middle;
  for (std::size_t c = 0; c < few.size(); ++c)
    few[c] = std::abs(cell_centre(block.cells[c], block.rest_positions).x()) < 40;  // 16, of which 8 count
  EXPECT_FALSE(midline_waviness_um(block, choose_furrow_sites(block, few, 1), block.rest_positions));
}

// From the shell along any direction in y = 0: a sphere's chord, a pill's straight side and caps.
TEST(Furrow, DepthInsideACapsuleIsTheWayOut) {
  const OuterShape sphere(Capsule{0, 10}), pill(Capsule{20, 10});
  for (double angle = 0; angle < 6.28; angle += 0.1) {
    const Vec3 outward(std::sin(angle), 0, std::cos(angle)), across(outward.z(), 0, -outward.x());
    EXPECT_NEAR(sphere.depth(3 * outward + 6 * across, outward), 5, 1e-12);
    EXPECT_NEAR(sphere.depth(9 * outward + 6 * across, outward), -1, 1e-12);
    // Where the way out ends, the shell is R from the axis.
    const Vec3 from(7, 0, -4), out = from + pill.depth(from, outward) * outward;
    EXPECT_NEAR(Vec3(out.x() - std::clamp(out.x(), -20.0, 20.0), 0, out.z()).norm(), 10, 1e-9) << angle;
  }
}

// Three rows, of which the last lacks two values.
std::vector<Observation> three_rows() {
  std::vector<Observation> rows(3);
  const auto put = [&](std::size_t row, std::string_view name, double value) {
    rows[row].values[column_index(name)] = value;
  };
  const double depths[] = {0, 5, 3}, errors[] = {1e-10, 3e-10, 2e-10}, jacobians[] = {0.9, 0.7, 0.8};
  for (std::size_t r = 0; r < 3; ++r) {
    put(r, "time_s", static_cast<double>(r));
    put(r, "furrow_depth_um", depths[r]);
    put(r, "max_volume_error", errors[r]);
    put(r, "min_scaled_jacobian", jacobians[r]);
  }
  put(1, "newton_iterations", 4), put(2, "newton_iterations", 3);
  put(1, "lip_distance_um", 50);
  put(1, "max_shell_penetration_um", 0.25);
  return rows;
}

TEST(Columns, TheSummaryHasWhatTheRowSays) {
  const std::vector<Observation> rows = three_rows();
  const auto value = [&](std::string_view name) { return summary_value(columns()[column_index(name)], rows); };
  EXPECT_EQ(value("furrow_depth_um"), 3);
  EXPECT_EQ(value("max_volume_error"), 3e-10);
  EXPECT_EQ(value("min_scaled_jacobian"), 0.7);
  EXPECT_EQ(value("newton_iterations"), 7);
  EXPECT_EQ(value("max_shell_penetration_um"), 0.25) << "what has no value does not count";
  EXPECT_FALSE(value("lip_distance_um")) << "the last has none";
  EXPECT_FALSE(value("peak_speed_ratio"));
}

const std::string sheet =
    "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 40\nwidth_um = 40\ncell_count = 30\ncell_height_um = "
    "10\n[region.middle]\ny_um = [-8, 8]\n[cortex.pull]\nregion = \"middle\"\ntension_mN_per_m = 0.3\n";
const std::string organoid =
    "format = 1\n[embryo]\nshape = \"sphere\"\ndiameter_um = 100\ncell_height_um = 15\ncells = [5, 5, 4]\naxes = "
    "[\"x\", \"y\", "
    "\"z\"]\n[vitelline]\nenabled = false\n[cortex.pull]\nregion = \"all\"\ntension_mN_per_m = 0.3\n";

std::vector<std::string> sets_of(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const MeasureSet& set : measure_sets())
    if (std::ranges::count(simulation.observer().columns(), set.name, &Column::set) > 0) names.emplace_back(set.name);
  return names;
}

TEST(MeasureSets, ATissueMeasuresWhatFitsIt) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(sets_of(Simulation(scenario_of(sheet))), (Names{"", "fold", "bending"}));
  EXPECT_EQ(sets_of(Simulation(scenario_of(organoid))), (Names{"", "lumen", "bending"}));
  EXPECT_EQ(sets_of(Simulation(scenario_of(small_furrow))), (Names{"", "fold", "furrow", "contact", "closing", "lumen",
                                                                   "shell", "perivitelline", "flanks", "bending"}));
  EXPECT_EQ(sets_of(Simulation(scenario_of(sheet + "[self_contact]\nsurface = \"apical\"\n"))),
            (Names{"", "fold", "contact", "bending"}));
}

TEST(MeasureSets, NoColumnIsEmpty) {
  for (const std::string& text : {sheet, organoid}) {
    const Scenario scenario = scenario_of(text);
    Simulation simulation(scenario);
    std::vector<Observation> rows = {simulation.measures()};
    for (int step = 0; step < 3 && simulation.step(); ++step) rows.push_back(simulation.measures());
    for (const Column* column : simulation.observer().columns())
      if (column->of_step) {
        EXPECT_TRUE(rows.back()[*column]) << column->name;
      }
    const std::vector<std::string> names = series_header(simulation.observer());
    EXPECT_TRUE(std::ranges::none_of(names, [](const std::string& name) { return name.starts_with("v"); }));
    for (const Column* column : simulation.observer().columns())
      EXPECT_TRUE(summary_value(*column, rows) || column->name.ends_with("_time_s")) << column->name;
    EXPECT_EQ(make_summary(scenario, simulation, rows, {}).contains("vml_height_um"), false);
  }
}

TEST(MeasureSets, AreThoseThatAreNamed) {
  const auto named = [](const std::string& sets, const std::string& more = "") {
    return sets_of(Simulation(scenario_of(sheet + "[measure]\nsets = [" + sets + "]\n" + more)));
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(named(""), (Names{""}));
  EXPECT_EQ(named("\"bending\""), (Names{"", "bending"}));
  EXPECT_EQ(named("\"furrow\""), (Names{"", "fold", "furrow"}));
  EXPECT_EQ(named("\"automatic\", \"closing\"", "[self_contact]\nsurface = \"apical\"\n"),
            (Names{"", "fold", "contact", "closing", "bending"}));
}

TEST(MeasureSets, OneThatDoesNotFitIsAnErrorWithARemedy) {
  const auto refusal = [](const std::string& more) {
    return error_of<ScenarioError>([&] { return Simulation(scenario_of(sheet + more)); });
  };
  EXPECT_SAYS(refusal("[measure]\nsets = [\"lumen\"]\n"), "measure.sets: \"lumen\" has nothing to measure");
  const std::string misspelt = refusal("[measure]\nsets = [\"fold\", \"furow\"]\n");
  EXPECT_SAYS(misspelt, "automatic | fold | furrow");
  EXPECT_SAYS(misspelt, "\"furow\" is unknown");
  EXPECT_SAYS(misspelt, "(nearest match: \"furrow\")");
  const std::string expectation = "[expect]\nlip_distance_um = { value = 3, within = 1 }\n";
  EXPECT_SAYS(refusal(expectation), "expect.lip_distance_um: is not measured; add \"furrow\" to measure.sets");
  EXPECT_EQ(refusal(expectation + "[measure]\nsets = [\"automatic\", \"furrow\"]\n"), "");
}

// A set that is not chosen computes nothing; what is left has the same values.
TEST(MeasureSets, OthersChangeNothing) {
  Simulation all(scenario_of(sheet + "[measure]\nsets = [\"automatic\", \"furrow\"]\n")), few(scenario_of(sheet));
  all.step(), few.step();
  for (const Column* column : few.observer().columns())
    EXPECT_EQ(all.measures()[*column], few.measures()[*column]) << column->name;
}

}  // namespace
