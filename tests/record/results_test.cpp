// Results: numbers, compression, tables read back, polygons; runs of scenarios: outcomes, settings, checkpoints on
// trial.
#include "record/results.hpp"

#include <zlib.h>

#include <bit>
#include <csignal>
#include <new>

#include "core/files.hpp"
#include "core/markup.hpp"
#include "core/numbers.hpp"
#include "measure/furrow.hpp"
#include "record/checkpoint.hpp"
#include "record/csv.hpp"
#include "record/polygon_surface.hpp"
#include "record/summary.hpp"
#include "simulation/division_rules.hpp"
#include "simulation/run_warnings.hpp"
#include "support/own_folder.hpp"
#include "support/prisms.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"

namespace {

namespace fs = std::filesystem;

class ResultsTest : public OwnFolder {};

TEST_F(ResultsTest, SeriesAtTimesOfRowsAndBetweenThem) {
  const Series series = read_series(write("series.csv", "time_s,a,b.c_um\n0,1,\n2,5,-1e-3\n4,,7\n"));
  EXPECT_EQ(series.columns, (std::vector<std::string>{"time_s", "a", "b.c_um"}));
  EXPECT_EQ(series.column("b.c_um"), 2U);
  EXPECT_FALSE(series.column("none"));
  EXPECT_EQ(series.at(1, 0), 1);
  EXPECT_EQ(series.at(1, 2 + 1e-9), 5);
  EXPECT_EQ(series.at(1, 0.5), 2);
  EXPECT_FALSE(series.at(1, 3)) << "nothing beside an empty field";
  EXPECT_FALSE(series.at(2, 1));
  EXPECT_DOUBLE_EQ(series.at(2, 3).value(), (7 - 1e-3) / 2);
  EXPECT_FALSE(series.at(1, -1));
  EXPECT_FALSE(series.at(2, 4.1));
}

TEST_F(ResultsTest, WhatIsNoSeriesNamesItsLine) {
  for (const auto& [text, part] : std::vector<std::pair<std::string, std::string>>{
           {"", ":1: "},
           {"depth,time_s\n1,2\n", ":1: "},
           {"time_s,a\n0,1\n1\n", ":3: has 1 fields for 2 columns"},
           {"time_s,a\n0,x\n", ":2: \"x\" is not a number"},
           {"time_s,a\n0,nan\n", ":2: \"nan\" is not a number"},
           {"time_s,a\n1,0\n1,0\n", ":3: time missing"},
           {"time_s,a\n,0\n", ":2: time missing"},
       }) {
    const fs::path file = write("series.csv", text);
    EXPECT_SAYS(error_of<FileError>([&] { return read_series(file); }), file.string() + part);
  }
}

TEST_F(ResultsTest, SummaryOrNone) {
  EXPECT_TRUE(read_summary(folder).is_null());
  write("summary.json", "{\"b\": 1, \"a\": null}");
  EXPECT_EQ(read_summary(folder).at("b"), 1);
  for (const char* text : {"{", "[1]", ""}) {
    write("summary.json", text);
    EXPECT_THROW((void)read_summary(folder), FileError) << text;
  }
}

std::string as_printf(double value) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

std::string number(double value) { return csv_rows(std::span<const double>(&value, 1), 1); }

TEST(Csv, NumbersAreAsPrintfGivesThem) {
  std::mt19937_64 random(7);
  std::vector<double> values = {1,    -1,   0.1,    1e9,        1e9 - 1,  1e10,   1e15, 123456789.5, 9999999999.5,
                                1e-4, 1e-5, 2.5e-7, 1e300,      5e-324,   1e-300, 0.5,  755,         1234567890.125,
                                -1e9, 1e22, 1e-10,  4294967296, 0.1 + 0.2};
  std::uniform_real_distribution<double> near(-500, 500);
  for (int i = 0; i < 20000; ++i) {
    values.push_back(near(random));
    const double any = std::bit_cast<double>(random());  // any bits
    if (std::isfinite(any)) values.push_back(any);
  }
  for (const double value : values) ASSERT_EQ(number(value), as_printf(value));
  RecordProperty("cases", static_cast<int>(values.size()));
}

TEST(Csv, WhatIsNotFiniteIsLeftEmptyAndZeroHasNoSign) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {nan, 1.5, -infinite, -0.0, 2, nan};
  EXPECT_EQ(csv_rows(values, 6), ",1.5,,0,2,");
  EXPECT_EQ(csv_rows(values, 3), ",1.5,\n0,2,");
  EXPECT_EQ(csv_rows({}, 3), "");
}

// Bits that a resumed run reads back, from values of any bits.
TEST(Csv, ARowIsReadBackAsItWas) {
  std::mt19937_64 random(8);
  for (int i = 0; i < 20000; ++i) {
    const double value = std::bit_cast<double>(random());
    const std::optional<double> read = number_in(csv_row(std::array{std::optional(value)}));
    if (std::isfinite(value))
      ASSERT_EQ(read, value);
    else
      ASSERT_FALSE(read);
  }
  EXPECT_EQ(csv_row(std::array{std::optional(-0.0), std::optional<double>(), std::optional(0.1)}), "0,,0.1");
}

class SeriesRows : public support::OwnFolder {
 protected:
  SeriesRows() {
    while (simulation.steps() < 3 && simulation.step()) rows.push_back(simulation.measures());
    header = fmt::format("{}\n", fmt::join(series_header(simulation.observer()), ","));
    for (const Observation& row : rows) text += series_row(row, simulation.observer().columns()) + '\n';
  }
  std::vector<Observation> read(const std::string& content) {
    return read_series_rows(write("series.csv", content), simulation.observer());
  }
  Simulation simulation{load_scenario(support::pulled_block())};
  std::vector<Observation> rows = {simulation.measures()};
  std::string header, text;
};

TEST_F(SeriesRows, AreReadBackAsTheyWere) {
  const std::vector<Observation> found = read(header + text);
  ASSERT_EQ(found.size(), 4U);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    EXPECT_EQ(found[r].values, rows[r].values);
    EXPECT_EQ(found[r].monitors, rows[r].monitors);
  }
}

TEST_F(SeriesRows, ThatDoNotFitAreRefused) {
  EXPECT_THROW(read("time_s,a\n0,1\n"), FileError);
  EXPECT_THROW(read(header + text + "1\n"), FileError) << "a short row";
  EXPECT_THROW(read(header + text + text), FileError) << "times that go back";
  Observation half = rows.back();
  half.values[column_index("cells")] = 5.5;
  EXPECT_THROW(read(header + series_row(half, simulation.observer().columns())), FileError);
}

std::string inflated(std::string_view bytes, std::size_t size) {
  std::string result(size, '\0');
  uLongf length = size;
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(result.data()), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                       bytes.size()),
            Z_OK);
  result.resize(length);
  return result;
}

TEST(Deflater, WhatItCompressesZlibGivesBack) {
  for (const Deflater::Effort effort : {Deflater::Effort::fast, Deflater::Effort::small}) {
    Deflater deflater(effort);
    for (const int size : {0, 1, 10000, 300000}) {
      std::string bytes, compressed = "before";
      for (int i = 0; i < size; ++i) bytes += static_cast<char>(i * (i % 17) % 251);
      const std::size_t count = deflater.append(bytes, compressed);
      ASSERT_EQ(compressed.size(), 6 + count);
      EXPECT_EQ(compressed.substr(0, 6), "before");
      EXPECT_EQ(inflated(std::string_view(compressed).substr(6), bytes.size()), bytes);
      EXPECT_LE(count, bytes.size() + 20);
      if (size > 1000) {
        EXPECT_LT(2 * count, bytes.size());
      }
    }
  }
}

// A run of an earlier version continues as it began.
class RunScenario : public OwnFolder {};

TEST_F(RunScenario, StayAsARunBegan) {
  const std::string text = "[embryo]\nshape = \"sheet\"\n";
  EXPECT_EQ(*as_begun(scenario_of(text), folder).elasticity.corner_barrier_Pa, 100);  // nothing is there yet
  write("scenario.toml", text + "[elasticity]\ncorner_barrier_Pa = 0\n[time]\nintegrator = \"backward-euler\"\n");
  const Scenario begun = as_begun(scenario_of(text), folder);
  EXPECT_EQ(*begun.elasticity.corner_barrier_Pa, 0);
  EXPECT_EQ(begun.time.integrator, "backward-euler");
  const Scenario given =
      as_begun(scenario_of(text, {"elasticity.corner_barrier_Pa=5", "time.integrator=bdf2"}), folder);
  EXPECT_EQ(*given.elasticity.corner_barrier_Pa, 5);
  EXPECT_EQ(given.time.integrator, "bdf2");
}

using Json = nlohmann::ordered_json;

const Tissue& sheet() {
  static const Tissue tissue = distorted_block({60, 40, 10, {6, 4, 1}, {1, 1, 1}}, 1, 3);
  return tissue;
}

const Tissue& closed() {
  static const Tissue tissue = build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}});
  return tissue;
}

const Json contracted = {{"furrow_depth_um", 28.9},
                         {"vml_apical_area_ratio", 0.68},
                         {"peak_speed_ratio", nullptr},
                         {"lips_closed", nullptr},
                         {"divisions", 0},
                         {"max_displacement_um", 32.5},
                         {"min_apical_area_ratio", 0.52},
                         {"lumen_volume_ratio", nullptr},
                         {"tissue_volume_ratio", 1}};

Json with(const Json& changes) {
  Json summary = contracted;
  summary.update(changes);
  return summary;
}

TEST(Outcome, OfAnEmbryoIsItsFurrow) {
  const Scenario pill = scenario_of("[embryo]\nshape = \"pill\"\n");
  EXPECT_EQ(outcome_text(pill, closed(), contracted), "furrow depth 28.90 um, apical area ratio 0.68 (midline centre)");
  EXPECT_EQ(outcome_text(pill, closed(), with({{"lips_closed", 1}, {"lips_closed_time_s", 900}})),
            "furrow depth 28.90 um, apical area ratio 0.68 (midline centre), lips closed at 15.00 min");
  EXPECT_EQ(outcome_text(pill, closed(), with({{"lips_closed", 0}, {"lips_closed_time_s", 900}, {"divisions", 2}})),
            "furrow depth 28.90 um, apical area ratio 0.68 (midline centre), lips open again, closed at 15.00 min, " +
                std::to_string(closed().cells.size()) + " cells after 2 divisions");
  EXPECT_EQ(outcome_text(
                pill, closed(),
                with({{"furrow_depth_um", nullptr}, {"vml_apical_area_ratio", nullptr}, {"lumen_volume_ratio", 1.2}})),
            "largest displacement 32.50 um, smallest apical area ratio 0.52, lumen volume ratio 1.20");
}

TEST(Outcome, OfOtherTissuesHasNoFurrow) {
  const Scenario flat = scenario_of("[embryo]\nshape = \"sheet\"\n");
  const std::string rest = "largest displacement 32.50 um, smallest apical area ratio 0.52";
  EXPECT_EQ(outcome_text(flat, sheet(), contracted), "fold depth 28.90 um, " + rest);
  EXPECT_EQ(outcome_text(flat, sheet(), with({{"furrow_depth_um", nullptr}, {"lumen_volume_ratio", 1}})), rest);
  EXPECT_EQ(outcome_text(flat, closed(),
                         with({{"furrow_depth_um", nullptr}, {"tissue_volume_ratio", 1.98}, {"divisions", 1}})),
            rest + ", " + std::to_string(closed().cells.size()) + " cells after 1 division, tissue volume ratio 1.98");
  const Scenario named = scenario_of("[embryo]\nshape = \"sheet\"\naxes = [\"x\", \"y\", \"ventral-dorsal\"]\n");
  EXPECT_TRUE(outcome_text(named, sheet(), contracted).starts_with("furrow depth 28.90 um"));
}

TEST(Outcome, TellsOfSelfIntersectionsWithTheirRemedy) {
  const Scenario none = scenario_of(""), both = scenario_of("[self_contact]\nsurface = \"both\"\n");
  const Json crossed = {{"self_intersections", 38}, {"self_intersections_time_s", 225}, {"lumen_volume_ratio", 0.9}};
  const std::string told = "self-intersects since 3.75 min (38 pairs of faces at most); later results are unphysical";
  EXPECT_EQ(crossing_text(none, crossed), told + crossing_remedy(none));
  EXPECT_EQ(crossing_text(both, crossed), told);
  EXPECT_EQ(crossing_text(none, {{"self_intersections", 0}, {"self_intersections_time_s", nullptr}}), "");
}

// What the FileError says that comes out; nothing when none does.
std::string complaint(const std::function<void()>& read) {
  return error_of<FileError>([&] { read_on_trial(read, 0); });
}

TEST(ReadingTrial, LetsErrorsOut) {
  EXPECT_EQ(complaint([] {}), "");
  EXPECT_EQ(complaint([] { throw FileError("it is damaged: a and b"); }), "it is damaged: a and b");
  EXPECT_THROW(read_on_trial([] { throw std::bad_alloc(); }, 0), std::bad_alloc);
}

TEST(ReadingTrial, OutlivesACrash) {
  EXPECT_EQ(complaint([] { (void)std::raise(SIGKILL); }), "it is damaged: HDF5 crashed while reading it");
}

// Three seconds of the processor's time: this test takes them.
TEST(ReadingTrial, OutlivesWhatNeverEnds) {
  const auto read = [] {
    volatile bool goes_on = true;
    while (goes_on) continue;
  };
  EXPECT_EQ(complaint(read), "it is damaged: HDF5 crashed while reading it");
}

Frame frame_of_tissue(const Tissue& tissue) {
  const FramePolygons polygons = polygons_of(tissue);
  MeshArrays arrays;
  std::vector<double> numbers;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) numbers.push_back(10.0 * static_cast<double>(c));
  arrays.cell_scalars.emplace_back("number", numbers);
  arrays.polygons = &polygons;
  return frame_of(tissue, tissue.rest_positions, arrays);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// Whatever elements a cell is made of, its polygon has its corners; nodes within edges are no vertices.
TEST(SurfaceMesh, IsThatOfTheCells) {
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites})
    for (const int layers : {1, 2}) {
      const PrismSheet sheet = irregular_polygons(6, 5, 4, 12, 0.1, 3);
      const Tissue tissue = tissue_from_prisms(sheet, split, layers);
      for (const bool apical : {true, false}) {
        const SurfaceMesh surface = surface_of(frame_of_tissue(tissue), apical);
        EXPECT_EQ(surface.points.size(), sheet.apical.size());
        ASSERT_EQ(surface.ends.size(), sheet.cells.size());
        std::size_t corner = 0;
        for (std::size_t c = 0; c < sheet.cells.size(); ++c) {
          ASSERT_EQ(static_cast<std::size_t>(surface.ends[c]) - corner, sheet.cells[c].size());
          for (const std::size_t vertex : sheet.cells[c])
            EXPECT_EQ(surface.points[surface.corners[corner++]], (apical ? sheet.apical : sheet.basal)[vertex]);
          EXPECT_EQ(surface.scalars.at(0).second[c], 10.0 * static_cast<double>(c));
        }
      }
    }
}

// A wall is the same line in both of its cells, also where one of them was cut: no vertex lies beside an edge, no edge
// within the tissue has one side, and areas are those of the cells.
TEST(SurfaceMesh, OfDividedCellsHasNoGaps) {
  Tissue tissue = tissue_from_prisms(irregular_polygons(6, 6, 8, 12, 0.1, 3), PolygonSplit::diagonals, 1);
  Vectors positions = tissue.rest_positions;
  for (int round = 0; round < 2; ++round) {
    std::vector<CellCut> cuts;
    CutEnds taken;
    for (std::size_t c = 7; c < tissue.cells.size(); c += 4)
      cuts.push_back(cut_by(DivisionPlane::longest_axis, tissue, CellId(c), positions, taken));
    const TissueChange division = divide(tissue, cuts, 0, positions);
    positions = with_new_nodes(tissue, division, positions);
    for (Vec3& x : positions) x += Vec3(0.3 * std::sin(x.y()), 0.3 * std::cos(2 * x.x()), 0);
    tissue.place_hanging(positions);
  }
  Frame frame = frame_of_tissue(tissue);
  frame.positions = positions;
  for (const bool apical : {true, false}) {
    const SurfaceMesh surface = surface_of(frame, apical);
    std::set<std::pair<int, int>> edges;
    std::vector<double> areas;
    int first = 0;
    for (const int end : surface.ends) {
      double area = 0;
      for (int i = first; i < end; ++i) {
        const int from = surface.corners[i], to = surface.corners[i + 1 < end ? i + 1 : first];
        EXPECT_TRUE(edges.emplace(from, to).second);
        area += 0.5 * surface.points[from].cross(surface.points[to]).z();
      }
      areas.push_back(area);
      first = end;
    }
    const auto lonely = std::ranges::count_if(edges, [&](const auto& edge) {
      return !edges.contains({edge.second, edge.first});
    });
    EXPECT_EQ(lonely, static_cast<long>(rim_of(tissue, apical ? tissue.apical_facets : tissue.basal_facets).size()));
    const std::vector<double> of_cells =
        apical ? face_areas(tissue, CellSide::apical, positions) : face_areas(tissue, CellSide::basal, positions);
    for (std::size_t c = 0; c < areas.size(); ++c) EXPECT_NEAR(areas[c], of_cells[c], 1e-9 * of_cells[c]) << c;
  }
}

TEST(SurfaceMesh, TablesNameVerticesEdgesAndFaces) {
  // Two squares of 20 x 20 beside each other.
  const Tissue block = build_block(
      {.length_um = 40, .width_um = 20, .cell_height_um = 20, .cells = {2, 1, 1}, .elements_per_cell = {2, 2, 2}});
  const auto [vertices, edges, faces] = tables_of(surface_of(frame_of_tissue(block), true));
  const std::vector<std::string> of_vertices = lines_of(vertices), of_edges = lines_of(edges),
                                 of_faces = lines_of(faces);
  ASSERT_EQ(of_vertices.size(), 7u);
  ASSERT_EQ(of_edges.size(), 9u);
  ASSERT_EQ(of_faces.size(), 3u);
  EXPECT_EQ(of_edges[0], "edge,srce,trgt,face,opposite,dx,dy,dz,length");
  EXPECT_EQ(of_edges[1], "0,0,1,0,-1,20,0,0,20");
  EXPECT_EQ(of_edges[2], "1,1,2,0,7,0,20,0,20");
  EXPECT_EQ(of_edges[8], "7,2,1,1,1,0,-20,0,20");
  EXPECT_EQ(of_faces[0], "face,x,y,z,num_sides,area,perimeter,number");
  EXPECT_EQ(of_faces[2].substr(0, 8), "1,10,0,1");
  EXPECT_EQ(of_faces[2].substr(of_faces[2].size() - 12), ",4,400,80,10");
}

TEST(SurfaceMesh, OfCellsOfOneElementIsThatOfTheirFaces) {
  const Tissue pill = build_shell({.length_um = 300, .diameter_um = 160, .cell_height_um = 30, .cells = {6, 4, 4}});
  const Frame with = frame_of_tissue(pill);
  Frame without = with;
  without.polygons = {};
  for (std::size_t e = 0; e < pill.elements.size(); ++e)
    without.element_scalars["cell_id"].push_back(static_cast<double>(e));
  for (const bool apical : {true, false}) {
    const SurfaceMesh a = surface_of(with, apical), b = surface_of(without, apical);
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.corners, b.corners);
  }
  without.element_scalars["cell_id"].back() = 0;
  EXPECT_THROW(surface_of(without, true), FileError);
}

TEST(SurfaceMesh, WhatIsDamagedIsRefused) {
  const Tissue block = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 20, .cells = {2, 1, 1}});
  const Frame good = frame_of_tissue(block);
  EXPECT_NO_THROW(surface_of(good, true));
  int cases = 0;
  const auto refuse = [&](const auto& damage) {
    Frame bad = good;
    damage(bad.polygons);
    EXPECT_THROW(surface_of(bad, true), FileError) << ++cases;
  };
  refuse([](FramePolygons& p) { p = {}; });
  refuse([](FramePolygons& p) { p.apical[3] = 999; });
  refuse([](FramePolygons& p) { p.apical[3] = -1; });
  refuse([](FramePolygons& p) { p.basal.pop_back(); });
  refuse([](FramePolygons& p) { p.ends[0] = 99; });
  refuse([](FramePolygons& p) { p.ends[0] = 1; });
  refuse([](FramePolygons& p) { p.ends.pop_back(); });
  refuse([](FramePolygons& p) { p.elements[1] = 2; });
}

}  // namespace
