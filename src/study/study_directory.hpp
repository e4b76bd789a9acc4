// What a study leaves: DIR with
//
//   study.toml     the study, as given          study.json  what it was begun with
//   points.csv     the runs, in their order     rows/       a file of rows for each process that ran some
//   runs.csv       a row a run, when it ended   points/     what is kept of each run, if anything
//   report.html    all of it, to look at        unfinished/ runs that take long, from minute to minute
//
// A row is written as soon as its run has ended, in one write: whatever is killed, other rows stay. Any number of
// processes may work in a directory at once, also on several machines that share it.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "study/study.hpp"

namespace plica {

/// What rows there are: by the number of the run, without its line's end.
using StudyRows = std::map<std::size_t, std::string>;

class StudyDirectory {
 public:
  enum class Start { fresh, over, resumed };

  /// Begins a study, or finds that it can go on with the one that is there. UsageError when there is another study, or
  /// none to go on with, or it was begun by another plica; FileError when it cannot be written.
  static StudyDirectory begin(const std::filesystem::path& directory, const Study& study, Start start);

  /// The study that a directory holds; to look at, or to run, which only the plica does that began it, and while the
  /// scenario is what it was. FileError when it holds none.
  static std::pair<StudyDirectory, Study> open(const std::filesystem::path& directory);
  static std::pair<StudyDirectory, Study> open_to_run(const std::filesystem::path& directory);
  /// The same without the study, to look at its rows, whichever plica began it.
  static StudyDirectory look(const std::filesystem::path& directory);

  [[nodiscard]] const std::filesystem::path& path() const { return directory_; }
  [[nodiscard]] StudyRows rows() const;
  /// Adds a row, in a file of this process's own.
  void add(std::size_t run, const std::string& row);
  /// Writes runs.csv: all rows; runs that have none stand there as not_run.
  void gather(const Study& study) const;

 private:
  explicit StudyDirectory(std::filesystem::path directory) : directory_(std::move(directory)) {}

  std::filesystem::path directory_;
  std::unique_ptr<RowFile> own_rows_;
};

/// How far a study is.
struct StudyStatus {
  std::size_t runs = 0;
  std::map<std::string, std::size_t> by_status;  // of runs that have ended
  std::map<std::string, std::size_t> by_reason;  // of those that were refused, failed or crashed
  double run_s = 0;                              // wall time of all runs together

  /// A row of one more that has ended.
  void add(const std::string& row, const Study& study);
  [[nodiscard]] std::size_t ended() const;
  /// Refused, failed or crashed.
  [[nodiscard]] std::size_t without_result() const;
};
StudyStatus status_of(const StudyDirectory& directory, const Study& study);

}  // namespace plica
