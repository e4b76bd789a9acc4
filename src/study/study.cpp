#include "study/study.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <chrono>
#include <new>
#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "show/recorded_run.hpp"
#include "study/csv_fields.hpp"
#include "study/quiet_run.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

// Remove the quotes of a TOML string; leave other values unchanged.
std::string shown(const std::string& in_toml) {
  if (!in_toml.starts_with('"')) return in_toml;
  const toml::table document = toml::parse("v = " + in_toml);
  return document["v"].value_or(in_toml);
}

std::string one_line(std::string text) {
  while (text.ends_with('\n')) text.pop_back();
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at)) text.replace(at, 1, " | ");
  return printable(text);
}

RunRow row_of(const Json& summary, const std::vector<std::string>& measures) {
  RunRow row;
  row.status = summary.at("status").get<std::string>();
  row.steps = summary.at("steps").get<int>();
  row.wall_s = summary.at("wall_s").get<double>();  // including earlier processes
  if (summary.contains("failure") && summary.at("failure").is_string())
    row.reason = summary.at("failure").get<std::string>();
  for (const std::string& name : measures) {
    const auto found = summary.find(name);
    const bool has_value = found != summary.end() && found->is_number();
    row.measures.push_back(has_value ? std::optional(found->get<double>()) : std::nullopt);
  }
  return row;
}

// Whether another process is running it.
bool is_taken(const fs::path& directory) {
  try {
    const DirectoryLock lock(directory);
    return false;
  } catch (const FileError&) {
    return true;
  }
}

}  // namespace

Study::Study(StudyInput input) : input_(std::move(input)) {
  try {
    design_ = design_of(input_);
    require_values_of_keys(input_, design_);
    check();
    require_usable_values(input_, design_);
  } catch (const ScenarioError& error) {
    throw in_study(error, input_);
  }
}

Study::Study(StudyInput input, StudyDesign design, std::vector<std::string> measures)
    : input_(std::move(input)), design_(std::move(design)), measures_(std::move(measures)) {}

// Output variables are those of the first valid point.
void Study::check() {
  std::optional<ScenarioError> first_error;
  std::vector<std::string> known;
  for (std::size_t r = 0; r < runs() && known.empty(); ++r) try {
      known = result_names(run_at_rest(scenario_of(r)).summary);
    } catch (const ScenarioError& error) {
      if (!first_error) first_error = error;
    }
  if (known.empty()) throw first_error.value();
  std::vector<Diagnostic> diagnostics;
  for (const std::string& name : input_.measures)
    if (std::ranges::count(known, name) == 0)
      diagnostics.push_back({input_.file, 0, "keep.measures",
                             fmt::format("\"{}\" is not a number of summary.json", name), result_remedy(name, known)});
  if (!diagnostics.empty()) throw ScenarioError(std::move(diagnostics));
  measures_ = input_.measures.empty() ? known : input_.measures;
  std::erase(measures_, "steps");  // has a column of its own
}

std::vector<Diagnostic> Study::notes() const {
  std::vector<Diagnostic> notes = input_.notes;
  notes.insert(notes.end(), design_.notes.begin(), design_.notes.end());
  return notes;
}

Scenario Study::scenario_of(std::size_t run) const {
  return load_scenario(input_.scenario, overrides_of(input_, design_, design_.runs[run]));
}

std::string Study::name_of(std::size_t run) const { return name_of_run(design_.runs[run], input_.replicates > 1); }

std::optional<RunRow> Study::run(std::size_t run, const fs::path& directory, const std::function<bool()>& stop) const {
  const auto start = std::chrono::steady_clock::now();
  const auto is_stopped = [&] { return stop && stop(); };
  const auto not_kept = [&](const Column& column) {
    const auto needs = [&](const std::string& name) { return name.starts_with(column.name); };  // or a time of it
    return column.is_costly && input_.each == KeptOfRun::row && std::ranges::none_of(measures_, needs);
  };
  RunRow row;
  try {
    const Scenario scenario = scenario_of(run);
    const bool is_recorded = input_.each == KeptOfRun::full;
    const fs::path place = directory / "points" / name_of(run), unfinished = directory / "unfinished" / name_of(run);
    if (is_taken(is_recorded ? place : unfinished)) return {};
    const Json summary = is_recorded ? run_recorded(place, scenario, input_.scenario, is_stopped)
                                     : quiet_run(scenario, {is_stopped, {}, not_kept, unfinished}).summary;
    row = row_of(summary, measures_);
    if (row.status == "interrupted") return {};
    if (input_.each == KeptOfRun::summary) {
      make_directory(place);
      write_file(place / "summary.json", summary.dump(2) + '\n');
    }
  } catch (const ScenarioError& error) {
    row = {"refused", {}, 0, 0, error.what()};
  } catch (const std::bad_alloc&) {
    row = {"failed", {}, 0, 0, "out of memory"};
  }
  row.measures.resize(measures_.size());
  row.wall_s = std::max(row.wall_s, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  return row;
}

std::string Study::header() const {
  std::string line = "point";
  for (const std::string& key : design_.keys) line += ',' + csv_field(key);
  line += ",replicate,status";
  for (const std::string& name : measures_) line += ',' + csv_field(name);
  return line + ",steps,wall_s,reason";
}

std::string Study::line_of(std::size_t run, const RunRow& row) const {
  const auto& [point, replicate, values, seeds] = design_.runs[run];
  std::string line = fmt::format("{}", point);
  for (const std::string& value : values) line += ',' + csv_field(one_line(shown(value)));
  line += fmt::format(",{},{}", replicate, row.status);
  for (const auto& value : row.measures) line += value ? fmt::format(",{}", *value) : ",";
  return line + fmt::format(",{},{:.3f},{}", row.steps, row.wall_s, csv_field(one_line(row.reason)));
}

}  // namespace plica
