// report.html of a study: one page with all runs, to sort, filter and plot; works offline.
//
// Data: name, scenario, design, `set`, `columns` and `arrays`. Columns: those of runs.csv, `seeds` and `kept` (files in
// points/). Numbers are stored as two halves of a double, or as float in large studies, missing ones as NaN; words as
// indices into the list of a column, from 1, 0 if missing. Shown by viewer/src/study/.
#pragma once

#include <filesystem>
#include <string>

namespace plica {

/// Whether a directory contains a study.
bool holds_study(const std::filesystem::path& directory);

/// Make the page of a study, finished or not, for a file in `place`, which determines its links to kept files. Throws
/// FileError without a study, for a damaged file, or if plica was built without its viewer.
std::string study_report_page(const std::filesystem::path& directory, const std::filesystem::path& place);

/// Write the page as DIR/report.html. Throws FileError as study_report_page does.
void write_study_report(const std::filesystem::path& directory);

}  // namespace plica
