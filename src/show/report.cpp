#include "show/report.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/markup.hpp"
#include "core/version.hpp"
#include "measure/reference_run.hpp"
#include "record/results.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/print.hpp"
#include "show/looks.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using nlohmann::ordered_json;

constexpr std::string_view title_place = "<!--plica:title-->", data_place = "<!--plica:data-->";

// Convert to JSON for a script element, without "</script>" and "<!--". Invalid UTF-8 becomes U+FFFD.
std::string in_script(const ordered_json& json) {
  const std::string text = json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::string result;
  result.reserve(text.size());
  for (const char c : text) {
    if (c == '<')
      result += "\\u003c";
    else
      result += c;
  }
  return result;
}

std::string replaced(std::string_view text, std::string_view place, const std::string& by) {
  const std::size_t at = text.find(place);
  if (at == std::string_view::npos) throw std::logic_error("the page has no place for its data");
  return fmt::format("{}{}{}", text.substr(0, at), by, text.substr(at + place.size()));
}

std::string text_of(const fs::path& file) { return is_there(file) ? read_file(file) : ""; }

ordered_json shell_json(const std::optional<Scenario>& scenario, const Vectors& rest_positions) {
  const std::optional<Capsule> shell = scenario ? shell_of_run(*scenario, rest_positions) : std::nullopt;
  if (!shell) return nullptr;
  return {{"half_axis_um", shell->half_axis_um}, {"radius_um", shell->radius_um}};
}

// Word for `furrow_depth_um`: of a furrow, of the fold of an open sheet; empty for other tissues.
const char* depth_word(const EmbryoAxes& axes, const std::vector<View>& views) {
  return have_furrow(axes) ? "furrow" : views.front().name == "apical" ? "fold" : "";
}

std::string hex(const Rgb& colour) {
  std::string text = "#";
  for (const double part : colour) text += fmt::format("{:02x}", std::lround(255 * part));
  return text;
}

const char* name_of(ScaleKind kind) {
  return kind == ScaleKind::from_zero ? "from-zero" : kind == ScaleKind::about ? "about" : "steps";
}

// Quantities common to all runs with snapshots, each with one scale for all of them.
ordered_json fields_json(const std::vector<ReportRun>& runs) {
  ordered_json fields = ordered_json::array();
  for (const ColourField& field : runs.front().colours) {
    if (std::ranges::any_of(
            runs, [&](const ReportRun& run) { return !run.fields.empty() && !run.fields.contains(field.name); }))
      continue;
    Quantiser all;
    for (const ReportRun& run : runs)
      if (const auto found = run.fields.find(field.name); found != run.fields.end())
        all.include(found->second.low), all.include(found->second.high);
    const ColourRange range = colour_range(field, all.low, all.high);
    fields.push_back({{"name", field.name},
                      {"label", field.label},
                      {"unit", field.unit},
                      {"on_nodes", field.on_nodes},
                      {"scale", name_of(field.kind)},
                      {"map", field.map().name},
                      {"low", range.low},
                      {"high", range.high}});
  }
  return fields;
}

ordered_json maps_json() {
  ordered_json maps;
  for (const ColourMap& map : colour_maps())
    for (const Rgb& colour : map.colours) maps[map.name].push_back(hex(colour));
  return maps;
}

// Views of the first run.
ordered_json views_json(const std::vector<ReportRun>& runs) {
  ordered_json list = ordered_json::array();
  for (const View& view : runs.front().views)
    list.push_back({{"name", view.name},
                    {"title", view.heading()},
                    {"label", view.label},
                    {"sight", {view.sight.x(), view.sight.y(), view.sight.z()}},
                    {"up", {view.up.x(), view.up.y(), view.up.z()}},
                    {"cut_axis", view.cut_axis ? ordered_json(*view.cut_axis) : ordered_json(nullptr)}});
  return list;
}

std::string title_of(const ReportRun& run) {
  const ordered_json& summary = run.json["summary"];
  const bool has_title = summary.is_object() && summary.contains("title") && summary["title"].is_string() &&
                         !summary["title"].get_ref<const std::string&>().empty();
  return has_title ? summary["title"].get<std::string>() : run.json["name"].get<std::string>();
}

// List each title once; runs of one scenario share theirs.
std::string title_of(const std::vector<ReportRun>& runs) {
  std::vector<std::string> titles;
  for (const ReportRun& run : runs)
    if (const std::string title = title_of(run); std::ranges::find(titles, title) == titles.end())
      titles.push_back(title);
  return fmt::format("{}", fmt::join(titles, " | "));
}

// Keys that differ between runs, with one value per run as in TOML; "" if missing. Runs without a scenario file are not
// compared.
ordered_json varied_json(const std::vector<ReportRun>& runs) {
  const auto scenario = [&](std::size_t r) { return runs[r].json["scenario"].get<std::string>(); };
  std::size_t first = 0;
  while (first < runs.size() && scenario(first).empty()) ++first;
  std::map<std::string, std::vector<std::string>> values;
  for (std::size_t r = first + 1; r < runs.size(); ++r) {
    if (scenario(r).empty()) continue;
    for (const KeyDifference& difference : scenario_differences(scenario(first), scenario(r))) {
      std::vector<std::string>& of_key = values[difference.key];
      if (of_key.empty())
        for (std::size_t i = 0; i < runs.size(); ++i) of_key.push_back(scenario(i).empty() ? "" : difference.a);
      of_key[r] = difference.b;
    }
  }
  ordered_json varied = ordered_json::array();
  for (const auto& [key, of_key] : values) varied.push_back({{"key", key}, {"values", of_key}});
  return varied;
}

// Prefix equal directory names by their parents: "young-500/run" and "young-1000/run".
void make_names_unique(const std::vector<fs::path>& directories, std::vector<ReportRun>& runs) {
  std::vector<fs::path> above;
  for (const auto& directory : directories) {
    const fs::path whole = fs::absolute(directory).lexically_normal();
    above.push_back((whole.has_filename() ? whole : whole.parent_path()).parent_path());
  }
  for (bool any = true; any;) {
    std::map<std::string, std::vector<std::size_t>> runs_of_name;
    for (std::size_t r = 0; r < runs.size(); ++r) runs_of_name[runs[r].json["name"].get<std::string>()].push_back(r);
    any = false;
    for (const auto& [name, same] : runs_of_name)
      if (same.size() > 1)
        for (const std::size_t r : same) {
          if (!above[r].has_filename()) continue;
          runs[r].json["name"] = fmt::format("{}/{}", above[r].filename().string(), name);
          above[r] = above[r].parent_path();
          any = true;
        }
  }
}

}  // namespace

#ifdef PLICA_REPORT_TEMPLATE
// Included by the assembler, since the compiler takes seconds for literals of this size.
#define PLICA_TEMPLATE(name, file)                                                     \
  __asm__(".pushsection .rodata\nplica_" #name ":\n.incbin \"" file "\"\nplica_" #name \
          "_end:\n.byte 0\n.popsection\n");                                            \
  extern "C" const char plica_##name[], plica_##name##_end[];                          \
  std::string_view name() { return {plica_##name, plica_##name##_end}; }
#else
#define PLICA_TEMPLATE(name, file) \
  std::string_view name() { return {}; }
#endif
PLICA_TEMPLATE(report_template, PLICA_REPORT_TEMPLATE)
PLICA_TEMPLATE(study_template, PLICA_STUDY_TEMPLATE)

std::string filled_page(std::string_view page, const std::string& title, const ordered_json& data,
                        const std::vector<PageBytes>& packed) {
  if (page.empty()) throw FileError("reports are not available (built with PLICA_WITH_VIEWER=OFF)");
  std::string elements = fmt::format("<script type=\"application/json\" id=\"data\">{}</script>\n", in_script(data));
  for (const auto& [id, bytes] : packed) {
    std::string deflated;
    Deflater(Deflater::Effort::small).append(bytes, deflated);
    elements += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, base64(deflated));
  }
  // Data first, so that a title containing the mark of another place is harmless.
  return replaced(replaced(page, data_place, elements), title_place, xml_escaped(title));
}

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
  require_results(directory);
  const bool has_frames = is_there(directory / "frames.pvd");
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

bool can_report() { return !report_template().empty(); }

std::string report_page_of(const std::vector<fs::path>& directories, const ordered_json& outcomes) {
  std::vector<ReportRun> runs;
  runs.reserve(directories.size());
  for (const auto& directory : directories)
    runs.push_back(read_report_run(directory, most_frame_bytes / static_cast<double>(directories.size())));
  if (outcomes.is_null())
    make_names_unique(directories, runs);
  else
    for (std::size_t r = 0; r < runs.size(); ++r) runs[r].json["name"] = outcomes.at("runs").at(r);
  return report_page(runs, outcomes);
}

std::string report_page(const std::vector<ReportRun>& runs, const ordered_json& outcomes) {
  ordered_json page = {{"format", 1},
                       {"made_by", fmt::format("plica {} ({})", version(), commit())},
                       {"fields", fields_json(runs)},
                       {"maps", maps_json()},
                       {"views", views_json(runs)},
                       {"view_cut_um", view_cut_um},
                       {"varied", varied_json(runs)},
                       {"outcomes", outcomes},
                       {"runs", ordered_json::array()}};
  std::vector<PageBytes> frames;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    page["runs"].push_back(runs[r].json);
    frames.push_back({fmt::format("frames-{}", r), runs[r].frames.bytes()});
  }
  const std::string title = outcomes.is_null() ? title_of(runs) : outcomes.at("title").get<std::string>();
  return filled_page(report_template(), title, page, frames);
}

}  // namespace plica
