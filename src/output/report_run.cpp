#include "output/report_run.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "measure/reference_run.hpp"
#include "output/looks.hpp"
#include "output/results.hpp"
#include "output/run_scenario.hpp"
#include "output/skin.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;
constexpr const char* region_prefix = "region_";

// What the page shows of a moment, until all moments are known and can be told in whole numbers.
struct Moment {
  double time_s = 0;
  std::vector<std::array<float, 3>> positions;
  std::vector<std::vector<float>> fields;  // in the order of colour_fields(); a value a node or a cell
};

// The frames between two divisions: the same cells of the same elements.
struct Topology {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<std::uint32_t> cell_of_element, cell_id, mother_id, generation, regions;
  std::vector<std::size_t> first_element;  // of each cell
  Skin skin;
  std::vector<Moment> moments;
};

std::string text_of(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? read_file(file) : "";
}

const std::vector<double>& cell_ids(const Frame& frame) {
  const auto found = frame.element_scalars.find("cell_id");
  if (found == frame.element_scalars.end()) throw FileError("the frame has no array cell_id; is it one of plica's?");
  return found->second;
}

// Bits in the order of the names of `regions`.
std::uint32_t region_bits(const Frame& frame, const std::vector<std::string>& regions, std::size_t element) {
  std::uint32_t bits = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const auto found = frame.element_scalars.find(region_prefix + regions[r]);
    if (found != frame.element_scalars.end() && found->second[element] != 0) bits |= std::uint32_t{1} << r;
  }
  return bits;
}

Topology topology_of(const Frame& frame, const std::vector<std::string>& regions) {
  Topology topology{frame.elements, {}, {}, {}, {}, {}, {}, skin_of(frame), {}};
  const auto value = [&](const char* name, std::size_t element) {
    const auto found = frame.element_scalars.find(name);
    return found == frame.element_scalars.end() ? 0.0 : found->second[element];
  };
  const std::vector<double>& ids = cell_ids(frame);
  std::map<double, std::uint32_t> number;
  for (std::size_t e = 0; e < ids.size(); ++e) {
    const auto [place, is_new] = number.emplace(ids[e], static_cast<std::uint32_t>(number.size()));
    topology.cell_of_element.push_back(place->second);
    if (!is_new) continue;
    topology.first_element.push_back(e);
    topology.cell_id.push_back(static_cast<std::uint32_t>(ids[e]));
    topology.mother_id.push_back(static_cast<std::uint32_t>(value("mother_id", e) + 1));
    topology.generation.push_back(static_cast<std::uint32_t>(value("generation", e)));
    topology.regions.push_back(region_bits(frame, regions, e));
  }
  return topology;
}

bool shows(const Topology& topology, const Frame& frame) {
  if (topology.elements != frame.elements) return false;
  const std::vector<double>& ids = cell_ids(frame);
  for (std::size_t e = 0; e < ids.size(); ++e)
    if (topology.cell_id[topology.cell_of_element[e]] != ids[e]) return false;
  return true;
}

Moment moment_of(const Frame& frame, const Topology& topology, double time_s) {
  Moment moment{time_s, {}, {}};
  for (const Vec3& position : frame.positions)
    moment.positions.push_back(
        {static_cast<float>(position.x()), static_cast<float>(position.y()), static_cast<float>(position.z())});
  for (const ColourField& field : colour_fields()) {
    const std::vector<double> values = field_values(frame, field);
    std::vector<float> kept;
    if (field.on_nodes)
      kept.assign(values.begin(), values.end());
    else
      for (const std::size_t element : topology.first_element) kept.push_back(static_cast<float>(values[element]));
    moment.fields.push_back(std::move(kept));
  }
  return moment;
}

// Times at which cells divided: after that row of series.csv there are more of them.
std::set<double> divisions_s(const fs::path& directory) {
  std::set<double> times;
  std::error_code error;
  if (!fs::exists(directory / "series.csv", error)) return times;
  const Series series = read_series(directory / "series.csv");
  const std::optional<std::size_t> cells = series.column("cells");
  for (std::size_t i = 0; cells && i + 1 < series.rows.size(); ++i)
    if (series.rows[i][*cells] != series.rows[i + 1][*cells]) times.insert(*series.rows[i].front());
  return times;
}

// The frames that are shown, by their number in the run. Returns each how many-th.
std::size_t choose_frames(const ReferenceRun& run, const Frame& last, const std::set<double>& divisions,
                          double most_bytes, std::vector<std::size_t>& chosen) {
  const std::vector<double> times = run.times_s();
  const auto on_nodes = static_cast<std::size_t>(std::ranges::count(colour_fields(), true, &ColourField::on_nodes));
  const std::size_t on_cells = colour_fields().size() - on_nodes;
  const double bytes_a_frame =
      2.0 * static_cast<double>(last.positions.size() * (3 + on_nodes) + last.elements.size() * on_cells);
  const std::size_t every = thinning(times.size(), bytes_a_frame, most_bytes);
  constexpr double same_time_s = 1e-6;
  const auto divides = [&](std::size_t i) {
    const auto division = divisions.lower_bound(times[i] - same_time_s);
    return division != divisions.end() && *division <= times[i] + same_time_s;
  };
  for (std::size_t i = 0; i < times.size(); ++i) {
    const bool last_one = i + 1 == times.size();
    if (i % every == 0 || last_one || divides(i) || (!last_one && divides(i + 1))) chosen.push_back(i);
  }
  return every;
}

std::vector<std::string> regions_of(const Frame& frame) {
  constexpr std::size_t most = 32;  // bits
  std::vector<std::string> names;
  for (const auto& [name, values] : frame.element_scalars)
    if (name.starts_with(region_prefix) && names.size() < most)
      names.push_back(name.substr(std::string(region_prefix).size()));
  return names;
}

ordered_json shell_json(const fs::path& directory, const Frame& rest) {
  const std::optional<Scenario> scenario = scenario_of_run(directory);
  const std::optional<Capsule> shell = scenario ? shell_of_run(*scenario, rest.positions) : std::nullopt;
  if (!shell) return nullptr;
  return {{"half_axis_um", shell->half_axis_um}, {"radius_um", shell->radius_um}};
}

template <class Ids>
std::vector<std::uint32_t> flat(const std::vector<Ids>& lists) {
  std::vector<std::uint32_t> numbers;
  for (const Ids& list : lists)
    for (const NodeId node : list) numbers.push_back(static_cast<std::uint32_t>(node.index()));
  return numbers;
}

void pack_structure(const Topology& topology, const std::string& prefix, PackedArrays& arrays) {
  const auto add = [&](const char* name, const std::vector<std::uint32_t>& values, std::size_t period) {
    arrays.add(prefix + name, std::span<const std::uint32_t>(values), period);
  };
  add("elements", flat(topology.elements), 8);
  add("cell_of_element", topology.cell_of_element, 1);
  std::vector<std::uint32_t> nodes, elements, faces;
  for (const SkinFacet& facet : topology.skin.facets) {
    for (const NodeId node : facet.nodes) nodes.push_back(static_cast<std::uint32_t>(node.index()));
    elements.push_back(static_cast<std::uint32_t>(facet.element));
    faces.push_back(static_cast<std::uint32_t>(facet.face));
  }
  add("facets", nodes, 4);
  add("element_of_facet", elements, 1);
  add("face_of_facet", faces, 1);
  add("outlines", flat(topology.skin.outlines), 2);
  add("cell_id", topology.cell_id, 1);
  add("mother_id", topology.mother_id, 1);
  add("generation", topology.generation, 1);
  add("regions", topology.regions, 1);
}

using Box = std::array<Quantiser, 3>;

void pack_moments(const Topology& topology, const std::string& prefix, const Box& box, ReportRun& run) {
  std::vector<std::uint16_t> steps;
  for (const Moment& moment : topology.moments)
    for (const auto& position : moment.positions)
      for (int i = 0; i < 3; ++i) steps.push_back(box[i].step_of(position[i]));
  run.frames.add(prefix + "positions", std::span<const std::uint16_t>(steps),
                 3 * topology.moments.front().positions.size());
  for (std::size_t f = 0; f < colour_fields().size(); ++f) {
    const std::string& name = colour_fields()[f].name;
    steps.clear();
    for (const Moment& moment : topology.moments)
      for (const float value : moment.fields[f]) steps.push_back(run.fields.at(name).step_of(value));
    run.frames.add(prefix + name, std::span<const std::uint16_t>(steps), topology.moments.front().fields[f].size());
  }
}

void pack(const std::vector<Topology>& topologies, ReportRun& run) {
  Box box;
  for (const Topology& topology : topologies)
    for (const Moment& moment : topology.moments) {
      for (const auto& position : moment.positions)
        for (int i = 0; i < 3; ++i) box[i].include(position[i]);
      for (std::size_t f = 0; f < colour_fields().size(); ++f)
        for (const float value : moment.fields[f]) run.fields[colour_fields()[f].name].include(value);
    }
  run.json["box"] = {{"low", {box[0].low, box[1].low, box[2].low}}, {"high", {box[0].high, box[1].high, box[2].high}}};
  for (const auto& [name, range] : run.fields) run.json["fields"][name] = {{"low", range.low}, {"high", range.high}};
  for (std::size_t t = 0; t < topologies.size(); ++t) {
    const Topology& topology = topologies[t];
    const std::string prefix = std::to_string(t) + "/";
    pack_structure(topology, prefix, run.frames);
    pack_moments(topology, prefix, box, run);
    ordered_json times = ordered_json::array();
    for (const Moment& moment : topology.moments) times.push_back(moment.time_s);
    run.json["topologies"].push_back({{"times_s", std::move(times)},
                                      {"nodes", topology.moments.front().positions.size()},
                                      {"elements", topology.elements.size()},
                                      {"cells", topology.cell_id.size()}});
  }
  run.json["arrays"] = run.frames.index();
}

void read_frames(const fs::path& directory, double most_bytes, ReportRun& run) {
  const ReferenceRun frames(directory);
  std::vector<std::size_t> chosen;
  run.json["every"] = choose_frames(frames, frames.last_frame(), divisions_s(directory), most_bytes, chosen);
  const std::vector<double> times = frames.times_s();
  run.json["frames_saved"] = times.size();
  std::vector<Topology> topologies;
  std::vector<std::string> regions;
  for (const std::size_t i : chosen) {
    const Frame frame = frames.frame(i);
    if (topologies.empty()) {
      regions = regions_of(frame);
      run.json["shell"] = shell_json(directory, frame);
    }
    if (topologies.empty() || !shows(topologies.back(), frame)) topologies.push_back(topology_of(frame, regions));
    topologies.back().moments.push_back(moment_of(frame, topologies.back(), times[i]));
  }
  run.json["regions"] = regions;
  pack(topologies, run);
}

}  // namespace

std::size_t thinning(std::size_t count, double bytes_a_frame, double most_bytes) {
  const auto most_frames = static_cast<std::size_t>(std::max(2.0, std::floor(most_bytes / bytes_a_frame)));
  return std::max<std::size_t>(1, (count + most_frames - 1) / most_frames);
}

ReportRun read_report_run(const fs::path& directory, double most_bytes) {
  std::error_code error;
  if (!fs::is_directory(directory, error)) throw FileError(directory.string() + ": there is no such directory");
  const fs::path absolute = fs::absolute(directory).lexically_normal();
  const std::string name = (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string();
  ReportRun run{{{"name", name},
                 {"summary", read_summary(directory)},
                 {"scenario", text_of(directory / "scenario.toml")},
                 {"series", text_of(directory / "series.csv")},
                 {"midline", text_of(directory / "midline.csv")},
                 {"shell", nullptr},
                 {"frames_saved", 0},
                 {"every", 1},
                 {"regions", ordered_json::array()},
                 {"topologies", ordered_json::array()},
                 {"arrays", ordered_json::array()}},
                {},
                {}};
  const bool has_frames = fs::exists(directory / "frames.pvd", error);
  if (run.json["series"].get<std::string>().empty() && !has_frames)
    throw FileError(directory.string() + ": holds no results; give the --out directory of a `plica run`");
  if (has_frames) read_frames(directory, most_bytes, run);
  return run;
}

}  // namespace plica
