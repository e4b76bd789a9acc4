#include "study/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "measure/energy_norm.hpp"
#include "record/mesh_writer.hpp"
#include "record/results.hpp"
#include "tissue/hexahedron.hpp"

namespace plica {
namespace {

/// Whether a number describes the clock or the solver rather than the tissue.
bool says_nothing_of_shape(const std::string& name) {
  return name == "time_s" || name == "step_s" || name == "steps" || name == "newton_iterations" ||
         name == "linear_iterations" || name == "peak_memory_MB" || name.starts_with("wall_") ||
         name.find(".wall_") != std::string::npos;
}

std::string text_of(const nlohmann::ordered_json& summary, const std::string& key) {
  return summary.is_object() && summary.contains(key) && summary.at(key).is_string()
             ? summary.at(key).get<std::string>()
             : "";
}

RunMoment moment_of(const ReferenceRun& run, const Frame& frame, const nlohmann::ordered_json& summary) {
  return {run.directory(), text_of(summary, "scenario"), text_of(summary, "status"),
          *frame.time_s,   frame.positions.size(),       frame.elements.size()};
}

/// Poisson's ratio of the run; empty if its scenario is missing or unreadable.
std::optional<double> poisson_ratio_of(const ReferenceRun& run) {
  const std::optional<Scenario> scenario = scenario_of_run(run.directory());
  return scenario ? std::optional(scenario->elasticity.poisson_ratio) : std::nullopt;
}

/// Compute the relative energy norm with the stiffness of b's undeformed mesh.
std::optional<double> energy_norm(const Frame& a, const Frame& b, double poisson_ratio) {
  const auto of_a = a.node_vectors.find("displacement_um"), of_b = b.node_vectors.find("displacement_um");
  if (of_a == a.node_vectors.end() || of_b == b.node_vectors.end()) return std::nullopt;
  Vectors rest = b.positions;
  for (std::size_t n = 0; n < rest.size(); ++n) rest[n] -= of_b->second[n];
  std::vector<HexPoints> shapes;
  for (const auto& element : b.elements) shapes.push_back(gather(rest, element));
  return relative_energy_norm({b.elements, shapes, {}}, poisson_ratio, of_a->second, of_b->second);
}

NodeComparison compare_nodes(const Frame& a, const Frame& b, std::optional<double> poisson_ratio) {
  NodeComparison result;
  result.farthest = NodeId(0);
  for (std::size_t n = 0; n < a.positions.size(); ++n) {
    const double distance = (a.positions[n] - b.positions[n]).norm();
    result.distances.mean += distance;
    result.distances.rms += distance * distance;
    if (distance > result.distances.max) result.distances.max = distance, result.farthest = NodeId(n);
  }
  const auto count = static_cast<double>(a.positions.size());
  result.distances.mean /= count;
  result.distances.rms = std::sqrt(result.distances.rms / count);
  if (poisson_ratio) result.relative_energy_norm = energy_norm(a, b, *poisson_ratio);
  return result;
}

SurfaceComparison compare_surfaces(const Frame& a, const Quads& facets_a, const Frame& b, const Quads& facets_b) {
  SurfaceComparison result;
  result.a_to_b = distances_to(SurfaceDistance(fine_triangles(b, facets_b)), a, facets_a);
  result.b_to_a = distances_to(SurfaceDistance(fine_triangles(a, facets_a)), b, facets_b);
  result.hausdorff = std::max(result.a_to_b.max, result.b_to_a.max);
  result.facet_error = std::max(facet_error(a, facets_a), facet_error(b, facets_b));
  return result;
}

double total_volume(const Frame& frame) {
  double volume = 0;
  for (const auto& element : frame.elements) volume += hex_volume(gather(frame.positions, element));
  return volume;
}

std::vector<KeyDifference> compare_scenarios(const ReferenceRun& a, const ReferenceRun& b) {
  std::vector<std::string> texts;
  for (const ReferenceRun* run : {&a, &b}) {
    const std::filesystem::path file = run->directory() / "scenario.toml";
    std::error_code error;
    if (!std::filesystem::exists(file, error)) return {};
    texts.push_back(read_file(file));
  }
  std::vector<KeyDifference> differences = scenario_differences(texts[0], texts[1]);
  // [expect] of a built-in scenario holds only for the scenario as it is.
  std::erase_if(differences, [](const KeyDifference& difference) { return difference.key.starts_with("expect."); });
  return differences;
}

std::vector<NumberPair> compare_summaries(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b) {
  std::vector<NumberPair> pairs;
  const auto add = [&](const std::string& key) {
    NumberPair pair{key, number_of(a, key), number_of(b, key)};
    const bool known = std::ranges::find(pairs, key, &NumberPair::name) != pairs.end();
    if ((pair.a || pair.b) && !known && (key == "time_s" || !says_nothing_of_shape(key))) pairs.push_back(pair);
  };
  for (const auto* summary : {&a, &b})
    if (summary->is_object())
      for (const auto& [key, value] : summary->items()) add(key);
  return pairs;
}

/// Read series.csv; a killed run may have none, then there is nothing to compare.
std::optional<Series> series_of(const ReferenceRun& run) {
  std::error_code error;
  const std::filesystem::path file = run.directory() / "series.csv";
  if (!std::filesystem::exists(file, error)) return std::nullopt;
  return read_series(file);
}

ColumnPair compare_column(const Series& a, std::size_t in_a, double until_a_s, const Series& b, std::size_t in_b,
                          double until_b_s) {
  ColumnPair pair{{a.columns[in_a], a.at(in_a, until_a_s), b.at(in_b, until_b_s)}, {}, 0};
  for (const auto& row : a.rows) {
    const double time_s = *row.front();
    if (time_s > std::min(until_a_s, until_b_s) + 1e-6) break;
    const std::optional<double> other = b.at(in_b, time_s);
    if (!row[in_a] || !other) continue;
    const double difference = std::abs(*row[in_a] - *other);
    if (!pair.largest_difference || difference > *pair.largest_difference)
      pair.largest_difference = difference, pair.largest_at_s = time_s;
  }
  return pair;
}

std::vector<ColumnPair> compare_series(const ReferenceRun& run_a, double until_a_s, const ReferenceRun& run_b,
                                       double until_b_s) {
  const std::optional<Series> a = series_of(run_a), b = series_of(run_b);
  std::vector<ColumnPair> pairs;
  if (!a || !b) return pairs;
  for (std::size_t column = 0; column < a->columns.size(); ++column) {
    const std::optional<std::size_t> other = b->column(a->columns[column]);
    if (other && !says_nothing_of_shape(a->columns[column]))
      pairs.push_back(compare_column(*a, column, until_a_s, *b, *other, until_b_s));
  }
  return pairs;
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

Comparison compare_runs(const ReferenceRun& run_a, const Frame& a, const ReferenceRun& run_b, const Frame& b) {
  const auto summary_a = read_summary(run_a.directory()), summary_b = read_summary(run_b.directory());
  const Quads apical_a = apical_facets(a), apical_b = apical_facets(b);
  Comparison result;
  result.a = moment_of(run_a, a, summary_a);
  result.b = moment_of(run_b, b, summary_b);
  result.scenario = compare_scenarios(run_a, run_b);
  if (a.elements == b.elements) result.nodes = compare_nodes(a, b, poisson_ratio_of(run_b));
  result.apical = compare_surfaces(a, apical_a, b, apical_b);
  result.geometry = {{"volume_um3", total_volume(a), total_volume(b)},
                     {"apical_area_um2", total_area(a, apical_a), total_area(b, apical_b)},
                     {"basal_area_um2", total_area(a, basal_facets(a)), total_area(b, basal_facets(b))}};
  result.summary = compare_summaries(summary_a, summary_b);
  result.series = compare_series(run_a, *a.time_s, run_b, *b.time_s);
  return result;
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
