#include "study/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "record/results.hpp"
#include "scenario/embryo_axes.hpp"
#include "show/report.hpp"
#include "study/csv_fields.hpp"
#include "study/study_directory.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

// Rows of rows/, else of runs.csv.
StudyRows rows_of(const fs::path& directory) {
  StudyRows rows = StudyDirectory::look(directory).rows();
  if (!is_there(directory / "runs.csv")) return rows;
  const auto table = csv_fields(read_file(directory / "runs.csv"));
  for (std::size_t r = 1; r < table.size(); ++r) {
    std::string row;
    for (const std::string& field : table[r]) {
      row += csv_field(field);
      row += ',';
    }
    row.pop_back();
    rows.try_emplace(r - 1, row);
  }
  return rows;
}

// Path of the most informative file kept of a run, below points/; empty without one.
std::string kept_of(const fs::path& points, const std::string& name) {
  for (const char* file : {"/report.html", "/summary.json"})
    if (is_there(points / (name + file))) return name + file;
  return "";
}

// Word for `furrow_depth_um`, by the axes of the scenario.
const char* depth_word(const fs::path& directory) {
  const std::optional<Scenario> scenario = scenario_of_run(directory);
  return !scenario || have_furrow(axes_of(scenario->embryo)) ? "furrow" : "fold";
}

// Description of the study from its file, if its scenario still exists; else from the scenario with all keys in the
// directory, which makes the same runs.
Json study_description(const fs::path& directory, const Json& begun) {
  const std::string name = begun.value("name", "study"), text = read_file(directory / "study.toml");
  Json data = {{"name", name},
               {"scenario", "scenario.toml"},
               {"scenario_argument", fs::absolute(directory / "scenario.toml").lexically_normal().string()},
               {"design", ""},
               {"set", Json::array()},
               {"log_keys", Json::array()},
               {"depth_word", depth_word(directory)},
               {"study", text}};
  try {
    const StudyInput input = parse_study(name, begun.value("file", "study.toml"), text);
    data["scenario"] = input.scenario.name;
    data["scenario_argument"] = input.scenario.file;
    data["design"] = word_of(input.kind);
    data["set"] = input.overrides;
    for (const StudyKey& key : input.keys)
      if (key.is_log) data["log_keys"].push_back(key.key);
  } catch (const ScenarioError&) {
    return data;
  }
  return data;
}

}  // namespace

bool holds_study(const fs::path& directory) { return is_there(directory / "study.json"); }

std::string study_report_page(const fs::path& directory, const fs::path& place) {
  const StudyRows rows = rows_of(directory);
  const Json begun = StudyDirectory::look(directory).begun();
  const std::string points = read_file(directory / "points.csv");
  const StudyDesign design = points_of_csv(points);
  const bool has_replicates = std::ranges::any_of(design.runs, [](const auto& run) { return run.replicate > 1; });
  const fs::path files = directory / "points";
  std::string lines, kept;
  for (std::size_t r = 0; r < design.runs.size(); ++r) {
    if (const auto row = rows.find(r); row != rows.end()) lines += row->second;
    lines += '\n';
    kept += kept_of(files, name_of_run(design.runs[r], has_replicates)) + '\n';
  }

  Json data = study_description(directory, begun);
  data["format"] = 1;
  data["made_by"] = fmt::format("plica {} ({})", version(), commit());
  data["begun_by"] = begun.value("plica", "");
  data["processor"] = begun.value("processor", "");
  data["runs"] = design.runs.size();
  data["points"] = fs::absolute(files).lexically_relative(fs::absolute(place).lexically_normal()).generic_string();
  data["measures"] = begun.value("measures", std::vector<std::string>());
  return filled_page(study_template(), data["name"].get<std::string>(), data,
                     {{"points", points}, {"rows", lines}, {"kept", kept}});
}

void write_study_report(const fs::path& directory) {
  write_file(directory / "report.html", study_report_page(directory, directory));
}

}  // namespace plica
