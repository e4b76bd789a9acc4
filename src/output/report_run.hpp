// One run as the page of a report holds it.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "output/packing.hpp"

namespace plica {

/// A run's tables and texts as JSON, its frames as packed numbers.
///
/// The JSON: `name`, `summary` and `scenario` (TOML) or null, `series`, `midline` (CSV) or empty, `shell`
/// {half_axis_um, radius_um} or null, `frames_saved`, `every` (k-th frame shown), `box` and `fields` (what 0 and 65535
/// stand for), `regions` (names), `arrays` (PackedArrays::index) and `topologies`: a list of {times_s, nodes, elements,
/// cells}, each for the frames between two divisions. Arrays of topology i, named "i/...": elements (8 nodes each),
/// cell_of_element, facets (4 nodes each), element_of_facet, face_of_facet, outlines (2 nodes each), cell_id, mother_id
/// (0: none, else one more), generation, regions (bits); then a frame after the other: positions (3 each), and each
/// field by its name.
struct ReportRun {
  nlohmann::ordered_json json;
  PackedArrays frames;
  std::map<std::string, Quantiser> fields;
};

/// Reads a directory of results. `most_bytes`: of its frames before compression (report.hpp).
ReportRun read_report_run(const std::filesystem::path& directory, double most_bytes);

/// Of `count` frames every k-th is kept, so that they take at most `most_bytes`: this k, 1 where all may stay.
std::size_t thinning(std::size_t count, double bytes_a_frame, double most_bytes);

}  // namespace plica
