#include "show/run_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/errors.hpp"
#include "record/results.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

double farthest_displacement_um(const Frame& frame) {
  const auto displacements = frame.node_vectors.find("displacement_um");
  double farthest = 0;
  if (displacements != frame.node_vectors.end())
    for (const Vec3& displacement : displacements->second) farthest = std::max(farthest, displacement.norm());
  return farthest;
}

// Point that views look at: the origin, or the centre of a body far from it (mesh from a file).
Vec3 far_middle(const Vectors& positions) {
  Vec3 low = positions.front(), high = low;
  for (const Vec3& position : positions) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  const Vec3 middle = 0.5 * (low + high);
  return middle.norm() > 0.25 * (high - low).maxCoeff() ? middle : Vec3(Vec3::Zero());
}

bool passes_through_itself(const Frame& frame) {
  const auto flags = frame.element_scalars.find("self_intersecting");
  return flags != frame.element_scalars.end() &&
         std::ranges::any_of(flags->second, [](double flag) { return flag > 0; });
}

std::vector<View> named_views_of(const Frame& rest, const EmbryoAxes& axes) {
  std::vector<View> views = views_of(rest);
  name_views(views, axes);
  return views;
}

}  // namespace

std::optional<double> nearest_time_s(const std::vector<double>& times_s, double time_s) {
  const double last_gap = times_s.size() > 1 ? times_s.back() - times_s[times_s.size() - 2] : 0;
  constexpr double slack_s = 1e-6;
  if (time_s < times_s.front() - slack_s || time_s > times_s.back() + last_gap / 2 + slack_s) return {};
  return *std::ranges::min_element(times_s, {}, [&](double time) { return std::abs(time - time_s); });
}

Picture rest_picture(Frame frame, const std::string& colour, const std::vector<std::string>& views,
                     const EmbryoAxes& axes) {
  std::vector<ColourField> fields;
  for (const auto& [name, values] : frame.element_scalars) {
    const auto known = std::ranges::find(colour_fields(), name, &ColourField::name);
    if (name != "cell_id")
      fields.push_back(known != colour_fields().end() ? *known : ColourField{name, name, "", name});
  }
  fields.insert(fields.begin(), *std::ranges::find(colour_fields(), "region", &ColourField::name));
  Picture picture;
  picture.field = named("--color", colour, fields);
  const std::vector<double> values = field_values(frame, picture.field);
  const auto [smallest, largest] = std::ranges::minmax(values);
  if (picture.field.kind == ScaleKind::steps) picture.step_names = step_names(frame, picture.field, largest);
  picture.range = colour_range(picture.field, smallest, largest);
  const std::vector<View> known = named_views_of(frame, axes);
  for (const std::string& name : views.empty() ? std::vector{known.front().name} : views) {
    const View& view = named("--view", name, known);
    picture.rows.push_back({view, half_size_um(frame.positions, view)});
  }
  picture.letters = picture_letters(axes);
  picture.columns.push_back({"", std::move(frame)});
  return picture;
}

RunPictures::RunPictures(std::filesystem::path directory, const PictureOptions& options)
    : run_(std::move(directory)), times_s_(run_.times_s()) {
  const std::optional<Scenario> scenario = scenario_of_run(run_.directory());
  const EmbryoAxes axes = scenario ? axes_of(scenario->embryo) : anatomical_axes();
  Frame rest = run_.frame(0);
  middle_ = far_middle(rest.positions);
  centre(rest);
  common_.field = named("--color", options.colour, fields_of(rest));
  add_rows(rest, options, axes);
  const auto [smallest, largest] = look_through();
  if (common_.field.kind == ScaleKind::steps) common_.step_names = step_names(rest, common_.field, largest);
  common_.range = options.range.value_or(colour_range(common_.field, smallest, largest));
  if (options.shell) add_shell(scenario, rest.positions);
  if (!scenario || !is_patch(shape_of(scenario->embryo))) common_.rest = std::move(rest);
  common_.edges = options.edges;
  common_.letters = picture_letters(axes);
  common_.width_px = options.width_px;
  common_.height_px = options.height_px;
}

void RunPictures::centre(Frame& frame) const {
  for (Vec3& position : frame.positions) position -= middle_;
}

// Views look at the centre of the body; positions are given in coordinates of the run.
void RunPictures::add_rows(const Frame& rest, const PictureOptions& options, const EmbryoAxes& axes) {
  const std::vector<View> views = named_views_of(rest, axes);
  if (options.usual_view) common_.rows.push_back({views.front()});
  for (const std::string& name : options.views) common_.rows.push_back({named("--view", name, views)});
  const auto [first, last] =
      std::ranges::minmax_element(rest.positions, {}, [](const Vec3& position) { return position.x(); });
  const double low = first->x() + middle_.x(), high = last->x() + middle_.x();
  std::vector<double> places = options.cuts_at_x_um;
  if (options.sections)
    for (const double part : {0.25, 0.5, 0.75}) places.push_back(low + part * (high - low));
  for (const double x : places) {
    if (x <= low || x >= high)
      throw UsageError(fmt::format(
          "--at-x-um: {:g} is outside the embryo; give x from {:.4g} to {:.4g} (reference state)", x, low, high));
    common_.rows.push_back({cross_section_at(x, axes)});
    common_.rows.back().view.cut_um -= middle_.x();
  }
}

// Find the space that the rows need, and the smallest and largest value of the field.
std::pair<double, double> RunPictures::look_through() {
  Extent values;
  for (std::size_t i = 0; i < times_s_.size(); ++i) {
    Frame frame = run_.frame(i);
    centre(frame);
    for (const double value : field_values(frame, common_.field))
      if (std::isfinite(value)) values.take(value);
    for (PictureRow& row : common_.rows) {
      const auto half = half_size_um(frame.positions, row.view);
      for (int k = 0; k < 2; ++k) row.half_size_um[k] = std::max(row.half_size_um[k], half[k]);
    }
    farthest_um_.push_back(farthest_displacement_um(frame));
  }
  return {values.low, values.high};
}

// The ends and sides of the shell determine the space it needs.
void RunPictures::add_shell(const std::optional<Scenario>& scenario, const Vectors& rest) {
  if (!scenario)
    throw FileError(run_.directory().string() + ": contains no scenario.toml that defines the vitelline membrane");
  common_.shell = shell_of_run(*scenario, rest);
  if (!common_.shell)
    throw FileError(run_.directory().string() + ": was run without a vitelline membrane; remove --shell");
  const double radius = common_.shell->radius_um, reach = common_.shell->half_axis_um + radius;
  for (PictureRow& row : common_.rows) {
    const auto half = half_size_um({{reach, 0, 0}}, row.view);
    for (int k = 0; k < 2; ++k) row.half_size_um[k] = std::max({row.half_size_um[k], half[k], radius});
  }
}

std::vector<double> RunPictures::telling_times_s(int count) const {
  const double farthest = *std::ranges::max_element(farthest_um_);
  std::vector<double> times;
  for (int k = 0; k < count; ++k) {
    const double part = static_cast<double>(k) / std::max(1, count - 1);
    double time_s = nearest_time_s(times_s_, times_s_.front() + part * (times_s_.back() - times_s_.front())).value();
    if (farthest > 0 && k > 0 && k + 1 < count) {
      const auto first = std::ranges::find_if(farthest_um_, [&](double um) { return um >= part * farthest; });
      time_s = times_s_[static_cast<std::size_t>(first - farthest_um_.begin())];
    }
    if (times.empty() || time_s > times.back()) times.push_back(time_s);
  }
  return times;
}

Picture RunPictures::picture(const std::vector<double>& times_s) const {
  Picture picture = common_;
  for (const double time_s : times_s) {
    std::optional<Frame> frame = run_.frame_at(time_s);
    if (!frame) throw FileError(fmt::format("{}: has no snapshot at {} s", run_.directory().string(), time_s));
    centre(*frame);
    const char* mark = passes_through_itself(*frame) ? ", self-intersecting" : "";
    picture.columns.push_back({time_text(time_s) + mark, std::move(*frame)});
  }
  return picture;
}

std::string RunPictures::time_text(double time_s) const {
  constexpr double longest_in_s = 90;
  return times_s_.back() < longest_in_s ? fmt::format("{:.3g} s", time_s) : fmt::format("{:.3g} min", time_s / 60);
}

}  // namespace plica
