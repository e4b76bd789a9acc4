// report.html: one page with a run, or several side by side, that opens by double click without a network. The page
// itself is viewer/, bundled when plica is built; here its data are put in. docs/how-to/report.md describes both.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "show/report_run.hpp"

namespace plica {

/// Most bytes that the frames of all runs of a page may take before compression. Compressed and written as base64 they
/// are at most 4/3 of it, whatever they hold: under 40 MB with the page itself.
inline constexpr double most_frame_bytes = 28e6;

/// The page of these runs. FileError when plica was built without its viewer.
std::string report_page(const std::vector<ReportRun>& runs);

/// The page of directories that hold results of `plica run`, finished or not; what a run has not (yet) left is missing
/// on its page. Where frames take more than most_frame_bytes, some are left out (ReportFrames); the page says so.
/// FileError as above, and when a directory holds no results, or a file of it is damaged.
std::string report_page_of(const std::vector<std::filesystem::path>& directories);

/// Whether this build has its viewer.
bool can_report();

}  // namespace plica
