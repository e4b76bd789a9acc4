// The frames of a run that was done before, read back to measure against.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tissue/files/frame_file.hpp"

namespace plica {

/// The frames in a directory of results, listed at once and read when asked for.
class ReferenceRun {
 public:
  /// FileError when the directory is missing, holds no run (no frames.pvd) or no frame.
  explicit ReferenceRun(std::filesystem::path directory);

  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  [[nodiscard]] std::vector<double> times_s() const;  // of its frames, in their order; at least one

  /// The frame at a time, to 1e-6 s; nothing where the run has none then.
  [[nodiscard]] std::optional<Frame> frame_at(double time_s) const;
  [[nodiscard]] Frame last_frame() const;
  [[nodiscard]] Frame frame(std::size_t index) const;  // in the order of times_s()

 private:
  std::filesystem::path directory_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
};

}  // namespace plica
