// Directory of a study:
//
//   study.toml     study as given               study.json  versions and names at the start
//   points.csv     runs in order                rows/       one file of rows per process
//   runs.csv       one row per run, at the end  points/     kept files of each run, if any
//   report.html    interactive page             unfinished/ state of long runs, saved every 30 s
//
// A row is written in one write as soon as its run has ended, so a killed process loses no other row. Several processes
// may use a directory at once, also on several machines that share it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "study/study.hpp"

namespace plica {

/// Existing rows by number of the run, without line ends.
using StudyRows = std::map<std::size_t, std::string>;

class StudyDirectory {
 public:
  enum class Start { fresh, over, resumed };

  /// Start a study, or prepare to continue the existing one. Throws UsageError if the directory contains another study,
  /// no study to continue, or one of another version; FileError if it cannot be written.
  static StudyDirectory begin(const std::filesystem::path& directory, const Study& study, Start start);

  /// Open the study in a directory to read it, or to run it, which requires the same version of plica and an unchanged
  /// scenario. Throws FileError if there is none.
  static std::pair<StudyDirectory, Study> open(const std::filesystem::path& directory);
  static std::pair<StudyDirectory, Study> open_to_run(const std::filesystem::path& directory);
  /// Open only the rows of a study, made by any version.
  static StudyDirectory look(const std::filesystem::path& directory);

  [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
  /// Content of study.json. Throws FileError if it is damaged.
  [[nodiscard]] nlohmann::ordered_json begun() const;
  [[nodiscard]] StudyRows rows() const;
  [[nodiscard]] std::vector<std::size_t> open_runs() const;
  /// Add a row to the file of this process.
  void add(std::size_t run, const std::string& row);
  /// Write runs.csv with all rows; runs without a row have status not_run.
  void gather(const Study& study) const;

 private:
  explicit StudyDirectory(std::filesystem::path directory) : directory_(std::move(directory)) {}

  std::filesystem::path directory_;
  std::unique_ptr<RowFile> own_rows_;
};

struct StudyStatus {
  std::size_t runs = 0;
  std::map<std::string, std::size_t> by_status;  // of finished runs
  std::map<std::string, std::size_t> by_reason;  // of refused, failed and crashed runs
  double run_s = 0;                              // sum of wall times

  /// Count the row of one more finished run.
  void add(const std::string& row, const Study& study);
  [[nodiscard]] std::size_t ended() const;
  /// Number of refused, failed and crashed runs.
  [[nodiscard]] std::size_t without_result() const;
};
StudyStatus status_of(const StudyDirectory& directory, const Study& study);

}  // namespace plica
