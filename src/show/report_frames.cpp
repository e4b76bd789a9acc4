#include "show/report_frames.hpp"

#include <algorithm>
#include <cmath>

#include "show/boundary_surface.hpp"

namespace plica {
namespace {

using nlohmann::ordered_json;
constexpr std::size_t most_regions = 32;  // bits
constexpr std::size_t most_given_arrays = 16;

// Bits in the order of the names of `regions`.
std::uint32_t region_bits(const Frame& frame, const std::vector<std::string>& regions, std::size_t element) {
  std::uint32_t bits = 0;
  for (std::size_t r = 0; r < regions.size(); ++r) {
    const auto found = frame.element_scalars.find(std::string(region_prefix) + regions[r]);
    if (found != frame.element_scalars.end() && found->second[element] != 0) bits |= std::uint32_t{1} << r;
  }
  return bits;
}

FrameTopology topology_of(const Frame& frame, const std::vector<std::string>& regions) {
  FrameTopology topology{frame.elements, {}, {}, {}, {}, {}};
  const auto value = [&](const char* name, std::size_t element) {
    const auto found = frame.element_scalars.find(name);
    return found == frame.element_scalars.end() ? 0.0 : found->second[element];
  };
  const auto whole = [](const auto& number) { return static_cast<std::uint32_t>(number); };
  std::vector<std::uint32_t> elements, mothers, generations, bits, facets, elements_of_facets, faces, outlines;
  const std::vector<double>& ids = values_in(frame.element_scalars, "cell_id");
  std::map<double, std::uint32_t> number;
  for (std::size_t e = 0; e < ids.size(); ++e) {
    for (const NodeId node : frame.elements[e]) elements.push_back(whole(node.index()));
    const auto [place, is_new] = number.emplace(ids[e], whole(number.size()));
    topology.cell_of_element.push_back(place->second);
    if (!is_new) continue;
    topology.first_element.push_back(e);
    topology.cell_id.push_back(whole(ids[e]));
    mothers.push_back(whole(value("mother_id", e) + 1));
    generations.push_back(whole(value("generation", e)));
    bits.push_back(region_bits(frame, regions, e));
  }
  const BoundarySurface boundary = boundary_surface_of(frame);
  for (const BoundaryFacet& facet : boundary.facets) {
    for (const NodeId node : facet.nodes) facets.push_back(whole(node.index()));
    elements_of_facets.push_back(whole(facet.element));
    faces.push_back(whole(facet.face));
  }
  for (const auto& outline : boundary.outlines)
    for (const NodeId node : outline) outlines.push_back(whole(node.index()));
  topology.structure = {{"elements", elements, 8},
                        {"cell_of_element", topology.cell_of_element, 1},
                        {"facets", facets, 4},
                        {"element_of_facet", elements_of_facets, 1},
                        {"face_of_facet", faces, 1},
                        {"outlines", outlines, 2},
                        {"cell_id", topology.cell_id, 1},
                        {"mother_id", mothers, 1},
                        {"generation", generations, 1},
                        {"regions", bits, 1}};
  return topology;
}

bool shows(const FrameTopology& topology, const Frame& frame) {
  if (topology.elements != frame.elements) return false;
  const std::vector<double>& ids = values_in(frame.element_scalars, "cell_id");
  for (std::size_t e = 0; e < ids.size(); ++e)
    if (topology.cell_id[topology.cell_of_element[e]] != ids[e]) return false;
  return true;
}

FrameMoment moment_of(const Frame& frame, const std::vector<ColourField>& fields, const FrameTopology& topology,
                      double time_s, std::size_t number) {
  FrameMoment moment{time_s, number, false, {}, {}};
  for (const Vec3& position : frame.positions)
    moment.positions.push_back(
        {static_cast<float>(position.x()), static_cast<float>(position.y()), static_cast<float>(position.z())});
  for (const ColourField& field : fields) {
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

using Box = std::array<Quantiser, 3>;

void pack_moments(const FrameTopology& topology, const std::string& prefix, const Box& box, ReportRun& run) {
  std::vector<std::uint16_t> steps;
  for (const FrameMoment& moment : topology.moments)
    for (const auto& position : moment.positions)
      for (int i = 0; i < 3; ++i) steps.push_back(box[i].step_of(position[i]));
  run.frames.add(prefix + "positions", steps, 3 * topology.moments.front().positions.size());
  for (std::size_t f = 0; f < run.colours.size(); ++f) {
    const std::string& name = run.colours[f].name;
    steps.clear();
    const Quantiser& range = run.fields.at(name);
    for (const FrameMoment& moment : topology.moments)
      for (const float value : moment.fields[f]) steps.push_back(range.step_of(value));
    run.frames.add(prefix + "field/" + name, steps, topology.moments.front().fields[f].size());
  }
}

void pack_frames(const std::vector<FrameTopology>& topologies, ReportRun& run) {
  Box box;
  for (const FrameTopology& topology : topologies)
    for (const FrameMoment& moment : topology.moments) {
      for (const auto& position : moment.positions)
        for (int i = 0; i < 3; ++i) box[i].include(position[i]);
      for (std::size_t f = 0; f < run.colours.size(); ++f) {
        Quantiser& range = run.fields[run.colours[f].name];
        for (const float value : moment.fields[f]) range.include(value);
      }
    }
  run.json["box"] = {{"low", {box[0].low, box[1].low, box[2].low}}, {"high", {box[0].high, box[1].high, box[2].high}}};
  for (const auto& [name, range] : run.fields) run.json["fields"][name] = {{"low", range.low}, {"high", range.high}};
  for (std::size_t t = 0; t < topologies.size(); ++t) {
    const FrameTopology& topology = topologies[t];
    const std::string prefix = std::to_string(t) + "/";
    for (const auto& [name, values, period] : topology.structure) run.frames.add(prefix + name, values, period);
    pack_moments(topology, prefix, box, run);
    ordered_json times = ordered_json::array();
    for (const FrameMoment& moment : topology.moments) times.push_back(moment.time_s);
    run.json["topologies"].push_back({{"times_s", std::move(times)},
                                      {"nodes", topology.moments.front().positions.size()},
                                      {"elements", topology.elements.size()},
                                      {"cells", topology.cell_id.size()}});
  }
  run.json["arrays"] = run.frames.index();
}

// Size of a snapshot in the page before compression.
double bytes_of(const FrameMoment& moment) {
  std::size_t numbers = 3 * moment.positions.size();
  for (const auto& field : moment.fields) numbers += field.size();
  return static_cast<double>(sizeof(std::uint16_t) * numbers);
}

}  // namespace

void Quantiser::include(double value) {
  low = any_ ? std::min(low, value) : value;
  high = any_ ? std::max(high, value) : value;
  any_ = true;
}

std::uint16_t Quantiser::step_of(double value) const {
  if (!(high > low)) return 0;
  return static_cast<std::uint16_t>(std::lround(std::clamp((value - low) / (high - low), 0.0, 1.0) * 65535));
}

void ReportFrames::add(const Frame& frame, double time_s) {
  if (empty()) {
    regions_ = regions_of(frame);
    coloured_regions_ = coloured_regions(frame);
    regions_.resize(std::min(regions_.size(), most_regions));
    rest_positions_ = frame.positions;
    views_ = views_of(frame);
  }
  add_new_fields(frame);
  const bool new_cells = topologies_.empty() || !shows(topologies_.back(), frame);
  if (new_cells) {
    if (!topologies_.empty()) topologies_.back().moments.back().at_division = true;
    topologies_.push_back(topology_of(frame, regions_));
  } else {
    // The previous snapshot is no longer the last.
    std::vector<FrameMoment>& moments = topologies_.back().moments;
    const FrameMoment& before = moments.back();
    if (before.number % every_ != 0 && !before.at_division) {
      bytes_ -= bytes_of(before);
      moments.pop_back();
    }
  }
  FrameTopology& topology = topologies_.back();
  topology.moments.push_back(moment_of(frame, fields_, topology, time_s, seen_++));
  topology.moments.back().at_division = new_cells;
  bytes_ += bytes_of(topology.moments.back());
  thin_out();
}

void ReportFrames::add_new_fields(const Frame& frame) {
  for (ColourField& field : fields_of(frame)) {
    if (fields_.size() == colour_fields().size() + most_given_arrays) return;
    if (std::ranges::find(fields_, field.name, &ColourField::name) != fields_.end()) continue;
    fields_.push_back(std::move(field));
    for (FrameTopology& topology : topologies_)
      for (FrameMoment& moment : topology.moments) {
        bytes_ -= bytes_of(moment);
        moment.fields.emplace_back(topology.first_element.size(), 0.0F);
        bytes_ += bytes_of(moment);
      }
  }
}

void ReportFrames::thin_out() {
  while (bytes_ > most_bytes_ && every_ < seen_) {
    every_ *= 2;
    for (FrameTopology& topology : topologies_)
      std::erase_if(topology.moments, [&](const FrameMoment& moment) {
        const bool stays = moment.number % every_ == 0 || moment.at_division || moment.number + 1 == seen_;
        if (!stays) bytes_ -= bytes_of(moment);
        return !stays;
      });
  }
}

void ReportFrames::pack_into(ReportRun& run) const {
  run.json["frames_saved"] = seen_;
  run.json["every"] = every_;
  run.json["regions"] = regions_;
  run.json["coloured_regions"] = coloured_regions_;
  if (topologies_.empty()) return;
  run.views = views_;
  run.colours = fields_;
  pack_frames(topologies_, run);
}

}  // namespace plica
