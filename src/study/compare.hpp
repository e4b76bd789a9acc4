// Comparison of two runs: shapes at one time, and numbers.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "measure/reference_run.hpp"

namespace plica {

/// Read the snapshot of a run at a time, or its last. Throws UsageError if there is none.
Frame frame_to_compare(const ReferenceRun& run, std::optional<double> time_s);

/// Compare two snapshots and the numbers of their runs. Keys are listed in docs/how-to/compare.md; missing values are
/// null. Throws FileError or MeshError for an unreadable file.
nlohmann::ordered_json compare_runs(const ReferenceRun& run_a, const Frame& a, const ReferenceRun& run_b,
                                    const Frame& b);

/// Convert a comparison to tables for the terminal. Equal numbers are counted, not listed.
std::string comparison_text(const nlohmann::ordered_json& comparison);

/// Write the mesh of a for ParaView with `distance_um` of each node from the surfaces of b (node_distances) and, for
/// equal meshes, the vector `deviation_um` from the same node of b. Throws FileError.
void write_distances(const std::filesystem::path& file, const Frame& a, const Frame& b);

}  // namespace plica
