// One run as the page of a report holds it: its tables and texts as JSON, its frames as packed numbers.
//
// The JSON: `name`, `summary` or null, `scenario` (TOML), `series`, `midline` (CSV; empty where there is none), `shell`
// {half_axis_um, radius_um} or null, `frames_saved`, `every` (each how many-th frame is shown), `box` and `fields`
// (what 0 and 65535 stand for), `regions` (names), `coloured_regions` (those whose places are
// values of the field region), `arrays` (PackedArrays::index) and `topologies`: a list of {times_s,
// nodes, elements, cells}, each for the frames between two divisions. Arrays of topology i, named "i/...": elements (8
// nodes each), cell_of_element, facets (4 nodes each), element_of_facet, face_of_facet, outlines (2 nodes each),
// cell_id, mother_id (0: none, else one more), generation, regions (bits); then a frame after the other: positions (3
// each), and each field by its name.
#pragma once

#include <filesystem>

#include "show/report_frames.hpp"

namespace plica {

/// These frames with the tables and texts of the directory, which may be those of an unfinished run. FileError when one
/// is damaged.
ReportRun make_report_run(const std::filesystem::path& directory, const ReportFrames& frames);

/// The same with the directory's own frames. FileError also when it holds no results. `most_bytes`: as of ReportFrames.
ReportRun read_report_run(const std::filesystem::path& directory, double most_bytes);

}  // namespace plica
