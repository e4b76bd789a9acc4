// Snapshots of an earlier run, read for comparison.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tissue/files/frame_file.hpp"

namespace plica {

/// Check that a directory exists, as that of results. Throws FileError.
void require_results(const std::filesystem::path& directory);

/// Snapshots of a directory of results, listed at construction and read on demand.
class ReferenceRun {
 public:
  /// Throws FileError if the directory is missing or contains no run (frames.pvd) or snapshot.
  explicit ReferenceRun(std::filesystem::path directory);

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  [[nodiscard]] std::vector<double> times_s() const;  // in order; at least one

  /// Snapshot at a time, to 1e-6 s; empty if there is none.
  [[nodiscard]] std::optional<Frame> frame_at(double time_s) const;
  [[nodiscard]] Frame last_frame() const;
  [[nodiscard]] Frame frame(std::size_t index) const;  // in the order of times_s()

 private:
  std::filesystem::path directory_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
};

}  // namespace plica
