// Pictures of a run's frames: which moments, at which scale, in which colours.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "measure/reference_run.hpp"
#include "show/picture.hpp"

namespace plica {

struct PictureOptions {
  bool usual_view = false;              // a row of the first of the run's views_of()
  std::vector<View> views;              // then rows of these
  std::vector<double> cuts_at_x_um;     // then cross-sections at these places, as the run counts x
  bool sections = false;                // then those at a quarter, half and three quarters of the length at rest
  std::string colour = "displacement";  // what colours the cells: of the run's fields_of()
  std::optional<ColourRange> range;     // empty: what all frames of the run need
  bool edges = true;                    // outlines of cells
  bool shell = false;                   // the vitelline shell, where the scenario has one
  int width_px = 0, height_px = 0;      // as in Picture
};

/// A run whose frames have been looked through once: all its pictures have one colour scale and one size of panel.
class RunPictures {
 public:
  /// FileError when the directory holds no frames, the frames lack the field's array, or a shell is asked for that the
  /// run does not have. UsageError when there is no field of that name.
  RunPictures(std::filesystem::path directory, PictureOptions options);

  [[nodiscard]] const std::vector<double>& times_s() const { return times_s_; }  // of the frames

  /// The time of the nearest frame. Nothing for a time before the first frame, or further behind the last one than half
  /// of the distance between the last two.
  [[nodiscard]] std::optional<double> nearest_time_s(double time_s) const;

  /// Moments that tell the story: when a node has first moved by 0, 1/(count - 1), ..., all of the farthest
  /// displacement of the run. Without displacements in the frames, equal steps of time.
  [[nodiscard]] std::vector<double> telling_times_s(int count) const;

  /// The frames at these times (of times_s()), a column each.
  [[nodiscard]] Picture picture(const std::vector<double>& times_s) const;

  /// "5 min"; seconds where the run is shorter than a minute and a half.
  [[nodiscard]] std::string time_text(double time_s) const;

 private:
  void look_through();
  void centre(Frame& frame) const;
  void add_rows(const Frame& rest);
  void add_cuts(const Vectors& rest);

  ReferenceRun run_;
  PictureOptions options_;
  ColourField field_;
  std::vector<double> times_s_, farthest_um_;  // a frame each
  double smallest_ = 0, largest_ = 0;          // of the field, over all frames
  std::vector<PictureRow> rows_;
  Vec3 middle_ = Vec3::Zero();  // of the body at rest, where it lies far from the origin
  Frame rest_;
  bool is_embryo_ = true;
  std::optional<Capsule> shell_;
};

}  // namespace plica
