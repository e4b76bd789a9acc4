// report.html of a study: one page with all its runs, to sort, filter, plot and pick, that needs no network.
//
// Its data: what was begun (name, scenario, design, `set`), `columns` and `arrays`. Columns are those of runs.csv, and
// `seeds` and `kept` (what points/ holds of a run). Numbers are the two halves of a double, missing ones NaN, or of a
// float where a study is large; words are places in a column's list, from 1 on, and 0 is missing. viewer/src/study/
// shows them.
#pragma once

#include <filesystem>
#include <string>

namespace plica {

/// Whether a directory holds a study.
bool holds_study(const std::filesystem::path& directory);

/// The page of a study, finished or not, for a file in `place`, from where it links to what was kept of runs. FileError
/// when the directory holds no study, or a file of it is damaged, or plica was built without its viewer.
std::string study_report_page(const std::filesystem::path& directory, const std::filesystem::path& place);

/// Writes it as DIR/report.html. FileError as above.
void write_study_report(const std::filesystem::path& directory);

}  // namespace plica
