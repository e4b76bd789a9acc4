// Two runs held beside each other: shape against shape at one moment, number against number.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/reference_run.hpp"
#include "scenario/differences.hpp"
#include "study/frame_surface.hpp"

namespace plica {

/// One number of both runs. What a run has not is empty.
struct NumberPair {
  std::string name;
  std::optional<double> a, b;

  [[nodiscard]] bool same() const { return a == b; }
  [[nodiscard]] std::optional<double> difference() const {  // a - b
    return a && b ? std::optional(*a - *b) : std::nullopt;
  }
};

/// A column of series.csv over the times that both runs have.
struct ColumnPair {
  NumberPair at_time;                        // at the moments compared
  std::optional<double> largest_difference;  // |a - b| at a row of a, b linear between its rows; none without such
  double largest_at_s = 0;
};

/// What a moment of a run is made of.
struct RunMoment {
  std::filesystem::path directory;
  std::string scenario, status;  // of the whole run; empty without a summary
  double time_s = 0;
  std::size_t nodes = 0, elements = 0;
};

struct NodeComparison {
  Distances distances;
  NodeId farthest;
  std::optional<double> relative_energy_norm;  // of a's displacements, relative to b
};

struct SurfaceComparison {
  Distances a_to_b, b_to_a;
  double hausdorff = 0;    // the larger of both maxima
  double facet_error = 0;  // of the triangles that stand in for bilinear facets; um
};

struct Comparison {
  RunMoment a, b;
  std::vector<KeyDifference> scenario;  // keys that differ; none where a run has no scenario.toml
  std::optional<NodeComparison> nodes;  // only where both meshes have the same elements
  SurfaceComparison apical;
  std::vector<NumberPair> geometry;  // volume and areas at the moments compared
  std::vector<NumberPair> summary;   // numbers of summary.json: of the runs' ends
  std::vector<ColumnPair> series;    // columns that both have, up to the moments compared
};

/// The frame of a run at a time, or its last. UsageError when the run has none then.
Frame frame_to_compare(const ReferenceRun& run, std::optional<double> time_s);

/// Compares two frames and the numbers of their runs. FileError or MeshError when a file cannot be understood.
Comparison compare_runs(const ReferenceRun& run_a, const Frame& a, const ReferenceRun& run_b, const Frame& b);

/// A mesh of a at its moment, for ParaView: `distance_um` of each node from b's surfaces (node_distances) and, where
/// the meshes are the same, the vector `deviation_um` from the same node of b. FileError when it cannot be written.
void write_distances(const std::filesystem::path& file, const Frame& a, const Frame& b);

}  // namespace plica
