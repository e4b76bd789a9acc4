// Pictures of the snapshots of a run (times, scale, colours), and of an undeformed mesh.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "measure/reference_run.hpp"
#include "scenario/scenario.hpp"
#include "show/picture.hpp"

namespace plica {

struct PictureOptions {
  bool usual_view = false;              // first a row of the default view (views_of)
  std::vector<std::string> views;       // then one row per view, by name
  std::vector<double> cuts_at_x_um;     // then cross-sections at these x of the run
  bool sections = false;                // then those at 25, 50 and 75 % of the reference length
  std::string colour = "displacement";  // quantity, one of fields_of()
  std::optional<ColourRange> range;     // empty: range over the run
  bool edges = true;                    // outlines of cells
  bool shell = false;                   // draw the vitelline membrane
  int width_px = 0, height_px = 0;      // as in Picture
};

/// Time nearest to another; empty before the first, or beyond the last by more than half of the last interval.
std::optional<double> nearest_time_s(const std::vector<double>& times_s, double time_s);

/// Picture of an undeformed mesh, coloured by one of its arrays or `region`, with one row per view (none: the default
/// view). Throws UsageError for an unknown name.
Picture rest_picture(Frame frame, const std::string& colour, const std::vector<std::string>& views,
                     const EmbryoAxes& axes);

/// Pictures of one run, with a common colour scale and panel size from all its snapshots.
class RunPictures {
 public:
  /// Throws FileError without snapshots, for a missing array, or a requested shell that the run does not have;
  /// UsageError for an unknown quantity or view.
  RunPictures(std::filesystem::path directory, const PictureOptions& options);

  [[nodiscard]] const std::vector<double>& times_s() const { return times_s_; }  // of the snapshots

  /// Representative times: when a node first reaches 0, 1/(count - 1), ..., 1 of the largest displacement of the run.
  /// Without displacements, equal intervals.
  [[nodiscard]] std::vector<double> telling_times_s(int count) const;

  /// Describe a picture of the snapshots at these times (of times_s()), one column each.
  [[nodiscard]] Picture picture(const std::vector<double>& times_s) const;

  /// Format a time: "5 min", or seconds for runs shorter than 90 s.
  [[nodiscard]] std::string time_text(double time_s) const;

 private:
  void centre(Frame& frame) const;
  void add_rows(const Frame& rest, const PictureOptions& options, const EmbryoAxes& axes);
  std::pair<double, double> look_through();
  void add_shell(const std::optional<Scenario>& scenario, const Vectors& rest);

  ReferenceRun run_;
  std::vector<double> times_s_, farthest_um_;  // snapshots
  Vec3 middle_ = Vec3::Zero();                 // centre of the undeformed body, if far from the origin
  Picture common_;                             // without columns
};

}  // namespace plica
