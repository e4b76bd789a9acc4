// report.html: one page with a run, or several side by side, that works offline. The page is bundled from viewer/; this
// module inserts its data. See docs/how-to/report.md.
//
// JSON of a run: `name`, `summary` or null, `scenario` (TOML), `series`, `midline` (CSV; empty if missing), `shell`
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
#include <string>
#include <string_view>
#include <vector>

#include "show/report_frames.hpp"

namespace plica {

/// Bytes for an element of the page with this id; inserted deflated, as base64.
struct PageBytes {
  std::string id, bytes;
};

/// Bundled pages without data, for runs and studies; empty in builds without the viewer.
std::string_view report_template();
std::string_view study_template();

/// Insert title and data into a page. Throws FileError in builds without the viewer.
std::string filled_page(std::string_view page, const std::string& title, const nlohmann::ordered_json& data,
                        const std::vector<PageBytes>& packed);

/// Largest size of the snapshots of all runs of a page before compression. Compressed and as base64 they are at most
/// 4/3 of it: below 40 MB with the page itself.
inline constexpr double most_frame_bytes = 28e6;

/// Make the run from snapshots and the files of a directory, possibly of an unfinished run. Throws FileError for a
/// damaged file.
ReportRun make_report_run(const std::filesystem::path& directory, const ReportFrames& frames);

/// Read a run with its snapshots from a directory. `most_bytes`: as in ReportFrames. Throws FileError, also without
/// results.
ReportRun read_report_run(const std::filesystem::path& directory, double most_bytes);

/// Make the page of runs. Throws FileError in builds without the viewer.
std::string report_page(const std::vector<ReportRun>& runs, const nlohmann::ordered_json& outcomes = nullptr);

/// Make the page of directories of `plica run`, finished or not; missing files are left out. Snapshots beyond
/// most_frame_bytes are thinned out (ReportFrames), as stated on the page. Throws FileError as above, or without
/// results, or for a damaged file. `outcomes`: table of experiments with `title`, `runs` (names of the directories),
/// `of_claims`, `columns` and `rows`.
std::string report_page_of(const std::vector<std::filesystem::path>& directories,
                           const nlohmann::ordered_json& outcomes = nullptr);

/// Whether this build has its viewer.
bool can_report();

}  // namespace plica
