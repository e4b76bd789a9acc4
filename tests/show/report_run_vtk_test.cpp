#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "core/errors.hpp"
#include "record/mesh_writer.hpp"
#include "show/looks.hpp"
#include "show/report.hpp"
#include "support/own_folder.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;
using namespace support;

// The numbers of a packed array, read back as the page does it.
std::vector<std::uint32_t> unpacked(const ReportRun& run, const std::string& name) {
  for (const auto& entry : run.json["arrays"]) {
    if (entry["name"] != name) continue;
    const std::size_t count = entry["count"], period = entry["period"], offset = entry["offset"];
    const std::size_t size = entry["bits"].get<std::size_t>() / 8;
    std::vector<std::uint32_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t b = 0; b < size; ++b)
        numbers[i] |= std::uint32_t{static_cast<unsigned char>(run.frames.bytes()[offset + b * count + i])} << (8 * b);
      if (i >= period) numbers[i] += numbers[i - period];
      if (size == 2) numbers[i] &= 0xffff;
    }
    return numbers;
  }
  ADD_FAILURE() << "no array " << name;
  return {};
}

class ReportRunTest : public support::OwnFolder {
 protected:
  ReportRunTest() { fs::create_directories(folder / "frames"); }
  // Frame i is the block moved by i um along x; from frame `divided_at` on it is another one, of more cells. As in a
  // run, the row of series.csv at the time of the division still counts those before it. From `given_at` on there is an
  // array that is not plica's.
  void write_frames(int count, int divided_at = 1000, int given_at = 1000) const {
    std::vector<std::pair<double, std::string>> entries;
    for (int i = 0; i < count; ++i) {
      const Tissue& tissue = i < divided_at ? block : finer;
      Vectors positions = tissue.rest_positions, displacements(positions.size(), Vec3(i, 0, 0));
      for (Vec3& position : positions) position.x() += i;
      std::vector<int> ids(tissue.cells.size()), zeros(tissue.cells.size(), 0);
      std::vector<double> values(tissue.cells.size(), 0.25 * i);
      for (std::size_t c = 0; c < ids.size(); ++c) ids[c] = static_cast<int>(c);
      MeshArrays arrays;
      arrays.node_vectors = {{"displacement_um", displacements}, {"velocity_um_per_s", displacements}};
      arrays.cell_integers = {{"cell_id", ids}, {"generation", zeros}, {"region_some", zeros}};
      for (const char* name : {"volume_um3", "volume_error", "apical_area_ratio", "pressure_Pa", "activity"})
        arrays.cell_scalars.emplace_back(name, values);
      if (i >= given_at) arrays.cell_scalars.emplace_back("given", values);
      const std::string file = "frames/frame_" + std::to_string(i) + ".vtu";
      write_mesh(folder / file, tissue, positions, arrays, 10.0 * i);
      entries.emplace_back(10.0 * i, file);
    }
    write_collection(folder / "frames.pvd", entries);
  }

  const Tissue block = distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 2, 9);
  const Tissue finer = distorted_block({60, 40, 40, {3, 3, 1}, {1, 1, 1}}, 2, 9);
};

TEST_F(ReportRunTest, HoldsPositionsAndValuesOfEveryFrame) {
  write_frames(3);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.json["topologies"].size(), 1u);
  EXPECT_EQ(run.json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 10, 20}));
  const auto steps = unpacked(run, "0/positions");
  const std::size_t nodes = block.rest_positions.size();
  ASSERT_EQ(steps.size(), 3 * 3 * nodes);
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t i = 0; i < 3; ++i) {
        const double low = run.json["box"]["low"][i], high = run.json["box"]["high"][i];
        const double position = low + (high - low) * steps[3 * (f * nodes + n) + i] / 65535;
        const double expected = block.rest_positions[n][static_cast<int>(i)] + (i == 0 ? static_cast<double>(f) : 0.0);
        EXPECT_NEAR(position, expected, 0.51 * (high - low) / 65535);
      }
  const auto pressures = unpacked(run, "0/field/pressure");
  EXPECT_EQ(pressures.front(), 0u);
  EXPECT_EQ(pressures.back(), 65535u);
  EXPECT_DOUBLE_EQ(run.fields.at("pressure").high, 0.5);
  EXPECT_EQ(run.json["regions"], nlohmann::ordered_json({"some"}));
  EXPECT_EQ(run.json["coloured_regions"], nlohmann::ordered_json({"some"}));
}

TEST_F(ReportRunTest, NewCellsAreANewTopology) {
  write_frames(5, 3);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.json["topologies"].size(), 2u);
  EXPECT_EQ(run.json["topologies"][0]["cells"], 6);
  EXPECT_EQ(run.json["topologies"][1]["cells"], 9);
  EXPECT_EQ(run.json["topologies"][1]["times_s"], nlohmann::ordered_json({30, 40}));
}

TEST_F(ReportRunTest, AnArrayMayComeLater) {
  write_frames(5, 3, 2);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.colours.back().name, "given");
  EXPECT_DOUBLE_EQ(run.fields.at("given").high, 1);
  const auto values = unpacked(run, "0/field/given");
  ASSERT_EQ(values.size(), 3 * block.cells.size());
  EXPECT_EQ(values[2 * block.cells.size() - 1], 0u);
  EXPECT_EQ(values.back(), 32768u);
  EXPECT_EQ(unpacked(run, "1/field/given").back(), 65535u);
}

TEST_F(ReportRunTest, ThinsFramesByItsRuleAndSaysSo) {
  write_frames(20, 11);
  const double bytes_a_frame = 2.0 * static_cast<double>(finer.rest_positions.size() * 5 + finer.elements.size() * 9);
  const ReportRun run = read_report_run(folder, 7 * bytes_a_frame);
  EXPECT_EQ(run.json["every"], 4);
  EXPECT_EQ(run.json["frames_saved"], 20);
  // Every 4th, the last, and the two on both sides of the division at 110 s.
  EXPECT_EQ(run.json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 40, 80, 100}));
  EXPECT_EQ(run.json["topologies"][1]["times_s"], nlohmann::ordered_json({110, 120, 160, 190}));
  EXPECT_EQ(read_report_run(folder, 100 * bytes_a_frame).json["every"], 1);
  // However little there is room for, the ends and the division stay.
  EXPECT_EQ(read_report_run(folder, 1).json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 100}));
  EXPECT_EQ(read_report_run(folder, 1).json["topologies"][1]["times_s"], nlohmann::ordered_json({110, 190}));
}

// What a page of several runs says of them.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(ReportRunTest, SeveralRunsAreToldApartByKeysAndNames) {
  write_frames(1);
  std::vector<fs::path> runs;
  for (const auto& [name, scenario] : std::vector<std::pair<std::string, std::string>>{
           {"soft/run", "title = \"Fold\"\n[elasticity]\nyoung_modulus_Pa = 500\npoisson_ratio = 0.45\n"},
           {"stiff/run", "title = \"Fold\"\n[elasticity]\nyoung_modulus_Pa = 1000\npoisson_ratio = 0.45\n"},
           {"none", ""}}) {
    runs.push_back(folder / name);
    fs::create_directories(runs.back());
    fs::copy(folder / "frames", runs.back() / "frames");
    fs::copy(folder / "frames.pvd", runs.back() / "frames.pvd");
    std::ofstream(runs.back() / "summary.json") << R"({"title": "Fold"})";
    if (!scenario.empty()) std::ofstream(runs.back() / "scenario.toml") << scenario;
  }
  const std::string page = report_page_of(runs);
  EXPECT_NE(page.find("<title>Fold</title>"), std::string::npos);
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data["varied"],
            nlohmann::json::parse(R"([{"key": "elasticity.young_modulus_Pa", "values": ["500", "1000", ""]}])"));
  EXPECT_EQ(data["runs"][0]["name"], "soft/run");
  EXPECT_EQ(data["runs"][1]["name"], "stiff/run");
  EXPECT_EQ(data["runs"][2]["name"], "none");
}

TEST_F(ReportRunTest, PageOfASheetBeginsAtItsApicalSide) {
  write_frames(1);
  const nlohmann::json views = data_of(report_page_of({folder}))["views"];
  ASSERT_EQ(views.size(), plica::views().size());
  EXPECT_EQ(views[0]["name"], "apical");
  EXPECT_LT(views[0]["sight"][2], -0.9);
}

TEST_F(ReportRunTest, NamesFitTheTissue) {
  write_frames(1);
  const auto told = [&](const std::string& scenario) {
    std::ofstream(folder / "scenario.toml") << scenario;
    const nlohmann::json data = data_of(report_page_of({folder}));
    const nlohmann::json& run = data["runs"][0];
    return nlohmann::json{run["axes"][0], run["letters"][0], run["depth_word"], data["views"][2]["title"]};
  };
  const std::string sheet = "[embryo]\nshape = \"sheet\"\n";
  EXPECT_EQ(told(sheet), nlohmann::json::parse(R"([["\u2212x", "+x"], ["\u2212x", "+x"], "fold", "from \u2212z"])"));
  EXPECT_EQ(told(sheet + "axes = [\"proximal-distal\", \"left-right\", \"ventral-dorsal\"]\n"),
            nlohmann::json::parse(R"([["proximal", "distal"], ["P", "Di"], "furrow", "from ventral"])"));
  EXPECT_EQ(told(""), nlohmann::json::parse(R"([["anterior", "posterior"], ["A", "P"], "furrow", "ventral"])"));
}

TEST_F(ReportRunTest, PageHoldsNoMarkupOfTheScenario) {
  write_frames(2);
  std::ofstream(folder / "summary.json") << R"({"title": "</script><b>&\u2028"})";
  std::ofstream(folder / "scenario.toml") << "title = \"</script><!--plica:title-->\"\n";
  const std::string page = report_page_of({folder});
  EXPECT_EQ(page.find("</script><b>"), std::string::npos);
  EXPECT_EQ(page.find("<!--plica:"), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;b&gt;&amp;"), std::string::npos);
}

}  // namespace
}  // namespace plica
