#include "measure/reference_run.hpp"

#include <cmath>

#include "core/errors.hpp"
#include "core/files.hpp"

namespace plica {

void require_results(const std::filesystem::path& directory) {
  if (!is_there(directory))
    throw FileError(directory.string() + ": directory does not exist; give the --out directory of a `plica run`");
  if (!std::filesystem::is_directory(directory))
    throw FileError(directory.string() + ": is not a directory of results; give the --out directory of a `plica run`");
}

ReferenceRun::ReferenceRun(std::filesystem::path directory) : directory_(std::move(directory)) {
  require_results(directory_);
  if (!is_there(directory_ / "frames.pvd"))
    throw FileError(directory_.string() +
                    ": contains no run (no frames.pvd); give the --out directory of a `plica run`");
  frames_ = read_collection(directory_ / "frames.pvd");
  if (frames_.empty()) throw FileError((directory_ / "frames.pvd").string() + ": lists no snapshot");
}

std::vector<double> ReferenceRun::times_s() const {
  std::vector<double> times;
  for (const auto& [time_s, file] : frames_) times.push_back(time_s);
  return times;
}

std::optional<Frame> ReferenceRun::frame_at(double time_s) const {
  constexpr double same_time_s = 1e-6;
  for (std::size_t i = 0; i < frames_.size(); ++i)
    if (std::abs(frames_[i].first - time_s) <= same_time_s) return frame(i);
  return std::nullopt;
}

Frame ReferenceRun::last_frame() const { return frame(frames_.size() - 1); }

Frame ReferenceRun::frame(std::size_t index) const {
  Frame result = read_frame(directory_ / frames_[index].second);
  result.time_s = frames_[index].first;
  return result;
}

}  // namespace plica
