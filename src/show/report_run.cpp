#include "show/report_run.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"
#include "measure/reference_run.hpp"
#include "record/results.hpp"
#include "scenario/embryo_axes.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

std::string text_of(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error) ? read_file(file) : "";
}

ordered_json shell_json(const std::optional<Scenario>& scenario, const Vectors& rest_positions) {
  const std::optional<Capsule> shell = scenario ? shell_of_run(*scenario, rest_positions) : std::nullopt;
  if (!shell) return nullptr;
  return {{"half_axis_um", shell->half_axis_um}, {"radius_um", shell->radius_um}};
}

// Word for `furrow_depth_um`: of a furrow, of the fold of an open sheet; empty for other tissues.
const char* depth_word(const EmbryoAxes& axes, const std::vector<View>& views) {
  return have_furrow(axes) ? "furrow" : views.front().name == "apical" ? "fold" : "";
}

}  // namespace

ReportRun make_report_run(const fs::path& directory, const ReportFrames& frames) {
  const fs::path absolute = fs::absolute(directory).lexically_normal();
  const std::string name = (absolute.has_filename() ? absolute : absolute.parent_path()).filename().string();
  const std::optional<Scenario> scenario = scenario_of_run(directory);
  const EmbryoAxes axes = scenario ? axes_of(scenario->embryo) : anatomical_axes();
  ReportRun run{{{"name", name},
                 {"summary", read_summary(directory)},
                 {"scenario", text_of(directory / "scenario.toml")},
                 {"series", text_of(directory / "series.csv")},
                 {"midline", text_of(directory / "midline.csv")},
                 {"shell", frames.empty() ? ordered_json(nullptr) : shell_json(scenario, frames.rest_positions())},
                 {"axes", axes},
                 {"letters", letters_of(axes)},
                 {"topologies", ordered_json::array()},
                 {"arrays", ordered_json::array()}},
                {},
                {}};
  frames.pack_into(run);
  run.json["depth_word"] = depth_word(axes, run.views);
  name_views(run.views, axes);
  return run;
}

ReportRun read_report_run(const fs::path& directory, double most_bytes) {
  std::error_code error;
  if (!fs::exists(directory, error))
    throw FileError(directory.string() + ": directory does not exist; give the --out directory of a `plica run`");
  if (!fs::is_directory(directory, error))
    throw FileError(directory.string() + ": is not a directory of results; give the --out directory of a `plica run`");
  const bool has_frames = fs::exists(directory / "frames.pvd", error);
  if (!has_frames && text_of(directory / "series.csv").empty())
    throw FileError(directory.string() + ": contains no results; give the --out directory of a `plica run`");
  ReportFrames frames(most_bytes);
  if (has_frames) {
    const ReferenceRun run(directory);
    const std::vector<double> times = run.times_s();
    for (std::size_t i = 0; i < times.size(); ++i) frames.add(run.frame(i), times[i]);
  }
  return make_report_run(directory, frames);
}

}  // namespace plica
