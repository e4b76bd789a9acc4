// Comparison of two runs: shapes at one time, and numbers.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/reference_run.hpp"
#include "scenario/print.hpp"
#include "study/frame_surface.hpp"

namespace plica {

/// One number of both runs; empty if missing.
struct NumberPair {
  std::string name;
  std::optional<double> a, b;

  [[nodiscard]] bool same() const { return a == b; }
  [[nodiscard]] std::optional<double> difference() const {  // a - b
    return a && b ? std::optional(*a - *b) : std::nullopt;
  }
};

/// Column of series.csv over the times common to both runs.
struct ColumnPair {
  NumberPair at_time;                        // at the times compared
  std::optional<double> largest_difference;  // |a - b| at rows of a, b interpolated linearly; empty without rows
  double largest_at_s = 0;
};

/// Snapshot of a run: where, when and how large.
struct RunMoment {
  std::filesystem::path directory;
  std::string scenario, status;  // of the run; empty without a summary
  double time_s = 0;
  std::size_t nodes = 0, elements = 0;
};

struct NodeComparison {
  Distances distances;
  NodeId farthest;
  std::optional<double> relative_energy_norm;  // of the displacements of a, relative to b
};

struct SurfaceComparison {
  Distances a_to_b, b_to_a;
  double hausdorff = 0;    // larger of both maxima
  double facet_error = 0;  // of the triangles that approximate bilinear facets; um
};

struct Comparison {
  RunMoment a, b;
  std::vector<KeyDifference> scenario;  // keys that differ; none if a run has no scenario.toml
  std::optional<NodeComparison> nodes;  // only for meshes with equal elements
  SurfaceComparison apical;
  std::vector<NumberPair> geometry;  // volume and areas at the times compared
  std::vector<NumberPair> summary;   // numbers of summary.json, at the end of the runs
  std::vector<ColumnPair> series;    // common columns, up to the times compared
};

/// Read the snapshot of a run at a time, or its last. Throws UsageError if there is none.
Frame frame_to_compare(const ReferenceRun& run, std::optional<double> time_s);

/// Compare two snapshots and the numbers of their runs. Throws FileError or MeshError for an unreadable file.
Comparison compare_runs(const ReferenceRun& run_a, const Frame& a, const ReferenceRun& run_b, const Frame& b);

/// Write the mesh of a for ParaView with `distance_um` of each node from the surfaces of b (node_distances) and, for
/// equal meshes, the vector `deviation_um` from the same node of b. Throws FileError.
void write_distances(const std::filesystem::path& file, const Frame& a, const Frame& b);

}  // namespace plica
