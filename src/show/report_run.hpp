// Data of one run for a report page: tables and texts as JSON, snapshots as packed numbers.
//
// JSON: `name`, `summary` or null, `scenario` (TOML), `series`, `midline` (CSV; empty if missing), `shell`
// {half_axis_um, radius_um} or null, `axes` and `letters` (names of the low and high ends of x, y, z), `depth_word`
// ("furrow", "fold" or ""), `frames_saved`, `every` (interval of shown snapshots), `box` and `fields`
// (values of 0 and 65535), `regions` (names), `coloured_regions` (those whose indices are
// values of the field region), `arrays` (PackedArrays::index) and `topologies`: a list of {times_s,
// nodes, elements, cells}, each for the snapshots between two divisions. Arrays of topology i, named "i/...": elements
// (8 nodes each), cell_of_element, facets (4 nodes each), element_of_facet, face_of_facet, outlines (2 nodes each),
// cell_id, mother_id (0: none, else plus one), generation, regions (bits); then for each snapshot: positions (3
// each), and each field by name.
#pragma once

#include <filesystem>

#include "show/report_frames.hpp"

namespace plica {

/// Make the run from snapshots and the files of a directory, possibly of an unfinished run. Throws FileError for a
/// damaged file.
ReportRun make_report_run(const std::filesystem::path& directory, const ReportFrames& frames);

/// Read a run with its snapshots from a directory. `most_bytes`: as in ReportFrames. Throws FileError, also without
/// results.
ReportRun read_report_run(const std::filesystem::path& directory, double most_bytes);

}  // namespace plica
