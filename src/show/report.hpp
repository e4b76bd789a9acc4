// report.html: one page with a run, or several side by side, that works offline. The page is bundled from viewer/; this
// module inserts its data. See docs/how-to/report.md.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "show/report_run.hpp"

namespace plica {

/// Largest size of the snapshots of all runs of a page before compression. Compressed and as base64 they are at most
/// 4/3 of it: below 40 MB with the page itself.
inline constexpr double most_frame_bytes = 28e6;

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
