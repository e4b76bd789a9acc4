// report.html of a study: one page with all runs, to sort, filter and plot; works offline.
//
// Data: name, scenario, design, `set`, `measures`, and three deflated texts with one line per run: points.csv (after
// its heading), its row of runs.csv (empty if missing) and the path of a kept file in points/. Shown by
// viewer/src/study/.
#pragma once

#include <filesystem>
#include <string>

namespace plica {

bool holds_study(const std::filesystem::path& directory);

/// Make the page of a study, finished or not, for a file in `place`, which determines its links to kept files. Throws
/// FileError without a study, for a damaged file, or if plica was built without its viewer.
std::string study_report_page(const std::filesystem::path& directory, const std::filesystem::path& place);

/// Write the page as DIR/report.html. Throws FileError as study_report_page does.
void write_study_report(const std::filesystem::path& directory);

}  // namespace plica
