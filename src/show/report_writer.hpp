// Writer of the report.html of a run, while it is recorded.
#pragma once

#include <filesystem>

#include "record/recorder.hpp"
#include "show/report_frames.hpp"

namespace plica {

/// Writes report.html into the directory of a run at its end. Requires can_report().
class ReportWriter final : public RecordListener {
 public:
  explicit ReportWriter(std::filesystem::path directory);
  void add_frame(const Frame& frame, double time_s) override { frames_.add(frame, time_s); }
  void end() override;

 private:
  std::filesystem::path directory_;
  ReportFrames frames_;
};

}  // namespace plica
