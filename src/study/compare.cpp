#include "study/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "measure/energy_norm.hpp"
#include "record/mesh_writer.hpp"
#include "record/results.hpp"
#include "scenario/print.hpp"
#include "study/frame_surface.hpp"
#include "tissue/hexahedron.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

/// Whether a number describes the clock or the solver rather than the tissue.
bool says_nothing_of_shape(const std::string& name) {
  return name == "time_s" || name == "step_s" || name == "steps" || name == "newton_iterations" ||
         name == "linear_iterations" || name == "peak_memory_MB" || name.starts_with("wall_") ||
         name.find(".wall_") != std::string::npos;
}

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(nullptr); }

Json pair_json(std::optional<double> a, std::optional<double> b) {
  return {{"a", number(a)}, {"b", number(b)}, {"difference", number(a && b ? std::optional(*a - *b) : std::nullopt)}};
}

// Snapshot of a run: where, when and how large.
Json moment_json(const ReferenceRun& run, const Frame& frame, const Json& summary) {
  const auto text = [&](const char* key) {
    const bool has_text = summary.is_object() && summary.contains(key) && summary.at(key).is_string();
    return has_text ? summary.at(key) : Json(nullptr);
  };
  return {{"directory", run.directory().string()},
          {"scenario", text("scenario")},
          {"status", text("status")},
          {"time_s", *frame.time_s},
          {"nodes", frame.positions.size()},
          {"elements", frame.elements.size()}};
}

Json distances_json(const Distances& distances) {
  return {{"mean_um", distances.mean}, {"rms_um", distances.rms}, {"max_um", distances.max}};
}

/// Compute the relative energy norm of the displacements of a, with the stiffness of b's undeformed mesh; empty if the
/// scenario of b is missing or unreadable.
std::optional<double> energy_norm(const Frame& a, const Frame& b, const ReferenceRun& run_b) {
  const std::optional<Scenario> scenario = scenario_of_run(run_b.directory());
  const auto of_a = a.node_vectors.find("displacement_um"), of_b = b.node_vectors.find("displacement_um");
  if (!scenario || of_a == a.node_vectors.end() || of_b == b.node_vectors.end()) return std::nullopt;
  Vectors rest = b.positions;
  for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= of_b->second[n];
  std::vector<HexPoints> shapes;
  for (const auto& element : b.elements) shapes.push_back(gather(rest, element));
  return relative_energy_norm({b.elements, shapes, {}}, scenario->elasticity.poisson_ratio, of_a->second, of_b->second);
}

Json compare_nodes(const Frame& a, const Frame& b) {
  Distances distances;
  NodeId farthest(0);
  for (std::size_t n = 0; n < a.positions.size(); ++n) {
    const double distance = (a.positions[n] - b.positions[n]).norm();
    distances.mean += distance;
    distances.rms += distance * distance;
    if (distance > distances.max) distances.max = distance, farthest = NodeId(n);
  }
  const auto count = static_cast<double>(a.positions.size());
  distances.mean /= count;
  distances.rms = std::sqrt(distances.rms / count);
  Json result = distances_json(distances);
  result["farthest_node"] = farthest.number();
  return result;
}

Json compare_surfaces(const Frame& a, const Quads& facets_a, const Frame& b, const Quads& facets_b) {
  const Distances a_to_b = distances_to(SurfaceDistance(fine_triangles(b, facets_b)), a, facets_a);
  const Distances b_to_a = distances_to(SurfaceDistance(fine_triangles(a, facets_a)), b, facets_b);
  return {{"a_to_b", distances_json(a_to_b)},
          {"b_to_a", distances_json(b_to_a)},
          {"hausdorff_um", std::max(a_to_b.max, b_to_a.max)},
          {"facet_error_um", std::max(facet_error(a, facets_a), facet_error(b, facets_b))}};
}

double total_volume(const Frame& frame) {
  double volume = 0;
  for (const auto& element : frame.elements) volume += hex_volume(gather(frame.positions, element));
  return volume;
}

// Keys that differ, with their values; none if a run has no scenario.toml.
Json compare_scenarios(const ReferenceRun& a, const ReferenceRun& b) {
  Json keys = Json::object();
  std::vector<std::string> texts;
  for (const ReferenceRun* run : {&a, &b}) {
    const std::filesystem::path file = run->directory() / "scenario.toml";
    if (!is_there(file)) return keys;
    texts.push_back(read_file(file));
  }
  const auto value = [](const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); };
  // [expect] of a built-in scenario holds only for the scenario as it is.
  for (const auto& [key, of_a, of_b] : scenario_differences(texts[0], texts[1]))
    if (!key.starts_with("expect.")) keys[key] = {{"a", value(of_a)}, {"b", value(of_b)}};
  return keys;
}

Json compare_summaries(const Json& a, const Json& b) {
  Json pairs = Json::object();
  for (const Json* summary : {&a, &b})
    if (summary->is_object())
      for (const auto& [key, value] : summary->items())
        if ((number_of(a, key) || number_of(b, key)) && (key == "time_s" || !says_nothing_of_shape(key)))
          pairs[key] = pair_json(number_of(a, key), number_of(b, key));
  return pairs;
}

/// Read series.csv; a killed run may have none, then there is nothing to compare.
std::optional<Series> series_of(const ReferenceRun& run) {
  const std::filesystem::path file = run.directory() / "series.csv";
  if (!is_there(file)) return std::nullopt;
  return read_series(file);
}

// Values at the times compared, and the largest difference at rows of a up to then, with b interpolated linearly.
Json compare_column(const Series& a, std::size_t in_a, double until_a_s, const Series& b, std::size_t in_b,
                    double until_b_s) {
  Json pair = pair_json(a.at(in_a, until_a_s), b.at(in_b, until_b_s));
  for (const char* key : {"largest_difference", "largest_at_s"}) pair[key] = nullptr;
  for (const auto& row : a.rows) {
    const double time_s = *row.front();
    if (time_s > std::min(until_a_s, until_b_s) + 1e-6) break;
    const std::optional<double> other = b.at(in_b, time_s);
    if (!row[in_a] || !other) continue;
    const double difference = std::abs(*row[in_a] - *other);
    if (pair["largest_difference"].is_null() || difference > pair["largest_difference"].get<double>())
      pair["largest_difference"] = difference, pair["largest_at_s"] = time_s;
  }
  return pair;
}

Json compare_series(const ReferenceRun& run_a, double until_a_s, const ReferenceRun& run_b, double until_b_s) {
  const std::optional<Series> a = series_of(run_a), b = series_of(run_b);
  Json pairs = Json::object();
  for (std::size_t column = 0; a && b && column < a->columns.size(); ++column) {
    const std::string& name = a->columns[column];
    if (const std::optional<std::size_t> other = b->column(name); other && !says_nothing_of_shape(name))
      pairs[name] = compare_column(*a, column, until_a_s, *b, *other, until_b_s);
  }
  return pairs;
}

constexpr int name_width = 36;

std::string cell(const Json& value) {
  return value.is_number() ? fmt::format("{:>15.7g}", value.get<double>()) : fmt::format("{:>15}", "none");
}

std::string heading(const std::string& title, const std::vector<std::string>& columns) {
  std::string line = fmt::format("\n{:<{}}", title, name_width);
  for (const std::string& column : columns) line += fmt::format("{:>15}", column);
  return line + '\n';
}

std::string row(const std::string& name, const Json& values, const std::vector<const char*>& keys) {
  std::string line = fmt::format("  {:<{}}", name, name_width - 2);
  for (const char* key : keys) line += cell(values.at(key));
  return line + '\n';
}

std::string moment_line(char letter, const Json& moment) {
  const auto text = [&](const char* key, const char* before, const char* missing) {
    return moment.at(key).is_string() ? before + moment.at(key).get<std::string>() : missing;
  };
  return fmt::format("{}  {}: {}{}, frame at {:g} s, {} elements, {} nodes\n", letter,
                     moment.at("directory").get<std::string>(), text("scenario", "", "no summary"),
                     text("status", ", ", ""), moment.at("time_s").get<double>(),
                     moment.at("elements").get<std::size_t>(), moment.at("nodes").get<std::size_t>());
}

std::string same_line(std::size_t count) {
  return count == 0 ? "" : fmt::format("  {} more {} equal\n", count, count == 1 ? "is" : "are");
}

std::string distance_text(const Json& comparison) {
  const std::vector<const char*> keys = {"mean_um", "rms_um", "max_um"};
  std::string text = "\nThe meshes differ: no nodes to compare.\n";
  if (const Json& nodes = comparison.at("nodes"); !nodes.is_null()) {
    text = heading("node by node", {"mean", "rms", "max"}) + row("distance, um", nodes, keys);
    text.insert(text.size() - 1, fmt::format("  (node {})", nodes.at("farthest_node").get<std::size_t>()));
    text += row("relative energy norm", comparison, {"relative_energy_norm"});
  }
  const Json& apical = comparison.at("apical_surface");
  text += heading("apical surfaces", {"mean", "rms", "max"});
  text += row("from A to B, um", apical.at("a_to_b"), keys) + row("from B to A, um", apical.at("b_to_a"), keys);
  text += fmt::format("  {:<{}}{:>45.7g}\n", "Hausdorff distance, um", name_width - 2,
                      apical.at("hausdorff_um").get<double>());
  return text + fmt::format("  facets are cut into triangles, exact to {:.2g} um\n",
                            apical.at("facet_error_um").get<double>());
}

// Number of a key, or those of its list, as those of the other tables.
std::string key_value(const Json& of_key) {
  if (of_key.is_null()) return "none";
  const std::string whole = of_key.get<std::string>();
  std::string text;
  for (const char* at = whole.c_str(); *at != '\0';) {
    const bool begins = text.empty() || text.back() == '[' || text.back() == ' ';
    char* end = nullptr;
    const double number = begins && *at != ' ' ? std::strtod(at, &end) : 0;
    if (end != nullptr && end != at && (*end == '\0' || *end == ',' || *end == ']')) {
      text += fmt::format("{:.7g}", number);
      at = end;
    } else {
      text += *at++;
    }
  }
  return text;
}

std::string keys_text(const Json& keys) {
  if (keys.empty()) return "";
  std::size_t widest = name_width - 2, width = 13;  // as wide as its texts
  for (const auto& [key, values] : keys.items()) {
    widest = std::max(widest, key.size());
    for (const Json& value : values) width = std::max(width, key_value(value).size());
  }
  const auto line = [&](const std::string& name, const std::string& a, const std::string& b) {
    return fmt::format("{:<{}}  {:>{}}  {:>{}}\n", name, widest + 2, a, width, b, width);
  };
  std::string text = '\n' + line("keys of the scenario that differ", "A", "B");
  for (const auto& [key, values] : keys.items())
    text += line("  " + key, key_value(values.at("a")), key_value(values.at("b")));
  return text;
}

// Table of pairs; those without a difference are counted unless `all`.
std::string pairs_text(const std::string& table, const Json& pairs, const std::vector<const char*>& keys, bool all) {
  if (pairs.empty()) return "";
  std::string text = table;
  std::size_t same = 0;
  for (const auto& [name, pair] : pairs.items()) {
    const Json largest = pair.value("largest_difference", Json());
    if (all || pair.at("a") != pair.at("b") || (largest.is_number() && largest != 0.0))
      text += row(name, pair, keys);
    else
      ++same;
  }
  return text + same_line(same);
}

}  // namespace

Frame frame_to_compare(const ReferenceRun& run, std::optional<double> time_s) {
  if (!time_s) return run.last_frame();
  if (std::optional<Frame> frame = run.frame_at(*time_s)) return *std::move(frame);
  const std::vector<double> times = run.times_s();
  const double nearest = *std::ranges::min_element(times, {}, [&](double t) { return std::abs(t - *time_s); });
  throw UsageError(fmt::format("--time_s {}: {} has no snapshot at this time; give {} s (nearest) or {} s (last)",
                               *time_s, run.directory().string(), nearest, times.back()));
}

Json compare_runs(const ReferenceRun& run_a, const Frame& a, const ReferenceRun& run_b, const Frame& b) {
  const Json summary_a = read_summary(run_a.directory()), summary_b = read_summary(run_b.directory());
  const Quads apical_a = apical_facets(a), apical_b = apical_facets(b);
  const bool same_mesh = a.elements == b.elements;
  return {{"a", moment_json(run_a, a, summary_a)},
          {"b", moment_json(run_b, b, summary_b)},
          {"scenario", compare_scenarios(run_a, run_b)},
          {"same_mesh", same_mesh},
          {"nodes", same_mesh ? compare_nodes(a, b) : Json(nullptr)},
          {"relative_energy_norm", same_mesh ? number(energy_norm(a, b, run_b)) : Json(nullptr)},
          {"apical_surface", compare_surfaces(a, apical_a, b, apical_b)},
          {"geometry",
           {{"volume_um3", pair_json(total_volume(a), total_volume(b))},
            {"apical_area_um2", pair_json(total_area(a, apical_a), total_area(b, apical_b))},
            {"basal_area_um2", pair_json(total_area(a, basal_facets(a)), total_area(b, basal_facets(b)))}}},
          {"summary", compare_summaries(summary_a, summary_b)},
          {"series", compare_series(run_a, *a.time_s, run_b, *b.time_s)}};
}

std::string comparison_text(const Json& comparison) {
  const std::vector<const char*> numbers = {"a", "b", "difference"};
  return moment_line('A', comparison.at("a")) + moment_line('B', comparison.at("b")) +
         keys_text(comparison.at("scenario")) + distance_text(comparison) +
         pairs_text(heading("at these frames", {"A", "B", "A - B"}), comparison.at("geometry"), numbers, true) +
         pairs_text(heading("series.csv, at equal times", {"A's frame", "B's frame", "largest |A-B|", "at s"}),
                    comparison.at("series"), {"a", "b", "largest_difference", "largest_at_s"}, false) +
         pairs_text(heading("summary.json, at the runs' ends", {"A", "B", "A - B"}), comparison.at("summary"), numbers,
                    false);
}

void write_distances(const std::filesystem::path& file, const Frame& a, const Frame& b) {
  Tissue mesh;  // only what the writer needs: one element per cell
  mesh.rest_positions = a.positions;
  mesh.elements = a.elements;
  mesh.cells.resize(a.elements.size());
  for (std::size_t e = 0; e < a.elements.size(); ++e) mesh.element_cell.emplace_back(e);
  MeshArrays arrays;
  arrays.node_scalars = {{"distance_um", node_distances(a, b)}};
  Vectors deviations;
  if (a.elements == b.elements) {
    for (std::size_t n = 0; n < a.positions.size(); ++n) deviations.push_back(a.positions[n] - b.positions[n]);
    arrays.node_vectors = {{"deviation_um", deviations}};
  }
  write_mesh(file, mesh, a.positions, arrays, a.time_s);
}

}  // namespace plica
