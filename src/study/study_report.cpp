#include "study/study_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/numbers.hpp"
#include "core/version.hpp"
#include "record/results.hpp"
#include "scenario/embryo_axes.hpp"
#include "show/packing.hpp"
#include "show/report_page.hpp"
#include "study/csv_fields.hpp"
#include "study/study_directory.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

// Number of values above which output variables are stored as floats, to keep the page at a few MB.
constexpr std::size_t most_doubles = 700'000;

struct Column {
  std::string name, role;
  std::vector<std::string> texts;  // "" if missing
};

Json read_begun(const fs::path& directory) {
  try {
    return Json::parse(read_file(directory / "study.json"));
  } catch (const Json::exception&) {
    throw FileError((directory / "study.json").string() + ": is damaged");
  }
}

// Rows of rows/, else of runs.csv.
StudyRows rows_of(const fs::path& directory) {
  StudyRows rows = StudyDirectory::look(directory).rows();
  std::error_code error;
  if (!fs::exists(directory / "runs.csv", error)) return rows;
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

// Columns: point; keys as in points.csv (TOML); replicate, status, outputs, steps, wall_s and reason as in runs.csv.
std::vector<Column> columns_of(const StudyDesign& design, const std::vector<std::string>& measures,
                               const StudyRows& rows) {
  const std::size_t runs = design.runs.size(), status_at = design.keys.size() + 2;
  std::vector<Column> columns;
  const auto add = [&](const std::string& name, const std::string& role, const auto& text_of) {
    columns.push_back({name, role, {}});
    for (std::size_t r = 0; r < runs; ++r) columns.back().texts.push_back(text_of(r));
  };
  std::vector<std::vector<std::string>> fields(runs);
  for (const auto& [run, text] : rows) {
    auto parsed = csv_fields(text);
    if (run < runs && parsed.size() == 1 && parsed.front().size() == status_at + measures.size() + 4)
      fields[run] = std::move(parsed.front());
  }
  const auto field = [&](std::size_t at) {
    return [&, at](std::size_t r) { return fields[r].empty() ? std::string() : fields[r][at]; };
  };
  add("point", "point", [&](std::size_t r) { return fmt::format("{}", design.runs[r].point); });
  for (std::size_t k = 0; k < design.keys.size(); ++k)
    add(design.keys[k], "key", [&](std::size_t r) { return design.runs[r].values[k]; });
  add("replicate", "replicate", [&](std::size_t r) { return fmt::format("{}", design.runs[r].replicate); });
  add("status", "status",
      [&](std::size_t r) { return fields[r].empty() ? std::string("not_run") : fields[r][status_at]; });
  for (std::size_t m = 0; m < measures.size(); ++m) add(measures[m], "measure", field(status_at + 1 + m));
  add("steps", "steps", field(status_at + measures.size() + 1));
  add("wall_s", "wall_s", field(status_at + measures.size() + 2));
  add("reason", "reason", field(status_at + measures.size() + 3));
  add("seeds", "seeds", [&](std::size_t r) {
    std::string text;
    for (const std::string& seed : design.runs[r].seeds) text += (text.empty() ? "" : " ") + seed;
    return text;
  });
  return columns;
}

// Column of the kept files of each run.
Column kept_of(const fs::path& points, const StudyDesign& design) {
  Column kept{"kept", "kept", std::vector<std::string>(design.runs.size())};
  std::error_code error;
  if (!fs::is_directory(points, error)) return kept;
  const bool has_replicates = std::ranges::any_of(design.runs, [](const auto& run) { return run.replicate > 1; });
  for (std::size_t r = 0; r < design.runs.size(); ++r)
    for (const char* file : {"report.html", "summary.json"}) {
      const std::string link = name_of_run(design.runs[r], has_replicates) + '/' + file;
      if (!fs::exists(points / link, error)) continue;
      kept.texts[r] = link;
      break;
    }
  return kept;
}

bool are_numbers(const Column& column) {
  if (column.role == "status" || column.role == "reason" || column.role == "seeds" || column.role == "kept")
    return false;
  return column.role != "key" ||
         std::ranges::all_of(column.texts, [](const std::string& text) { return number_in(text).has_value(); });
}

void pack_numbers(const Column& column, const std::string& place, bool as_floats, PackedArrays& arrays) {
  std::vector<std::uint32_t> high, low;
  for (const std::string& text : column.texts) {
    const double value = number_in(text).value_or(std::numeric_limits<double>::quiet_NaN());
    if (as_floats) {
      high.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    } else {
      const auto bits = std::bit_cast<std::uint64_t>(value);
      high.push_back(static_cast<std::uint32_t>(bits >> 32U)), low.push_back(static_cast<std::uint32_t>(bits));
    }
  }
  arrays.add(place + (as_floats ? "/float" : "/high"), std::span<const std::uint32_t>(high), 1);
  if (!as_floats) arrays.add(place + "/low", std::span<const std::uint32_t>(low), 1);
}

Json pack_words(const Column& column, const std::string& place, PackedArrays& arrays) {
  Json words = Json::array();
  std::map<std::string, std::uint32_t> places;
  std::vector<std::uint32_t> codes;
  for (const std::string& text : column.texts) {
    if (text.empty()) {
      codes.push_back(0);
      continue;
    }
    const auto [found, is_new] = places.try_emplace(text, static_cast<std::uint32_t>(places.size() + 1));
    if (is_new) words.push_back(text);
    codes.push_back(found->second);
  }
  arrays.add(place + "/words", std::span<const std::uint32_t>(codes), 1);
  return words;
}

Json packed(const std::vector<Column>& columns, PackedArrays& arrays) {
  const auto measures = static_cast<std::size_t>(std::ranges::count(columns, "measure", &Column::role));
  const bool is_large = measures * columns.front().texts.size() > most_doubles;
  Json list = Json::array();
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const Column& column = columns[c];
    Json entry = {{"name", column.name}, {"role", column.role}};
    const std::string place = fmt::format("{}", c);
    if (are_numbers(column)) {
      const bool as_floats = is_large && column.role == "measure";
      pack_numbers(column, place, as_floats, arrays);
      entry["numbers"] = as_floats ? "float" : "double";
    } else {
      entry["words"] = pack_words(column, place, arrays);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

// Word for `furrow_depth_um`, by the axes of the scenario.
const char* depth_word(const fs::path& directory) {
  const std::optional<Scenario> scenario = scenario_of_run(directory);
  return !scenario || have_furrow(axes_of(scenario->embryo)) ? "furrow" : "fold";
}

// Description of the study from its file, if its scenario still exists; else from the scenario with all keys in the
// directory, which makes the same runs.
Json told(const fs::path& directory, const Json& begun) {
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

bool holds_study(const fs::path& directory) {
  std::error_code error;
  return fs::exists(directory / "study.json", error);
}

std::string study_report_page(const fs::path& directory, const fs::path& place) {
  const StudyRows rows = rows_of(directory);
  const Json begun = read_begun(directory);
  const StudyDesign design = points_of_csv(read_file(directory / "points.csv"));
  std::vector<Column> columns = columns_of(design, begun.value("measures", std::vector<std::string>()), rows);
  const fs::path points = directory / "points";
  columns.push_back(kept_of(points, design));

  PackedArrays arrays;
  Json data = told(directory, begun);
  data["format"] = 1;
  data["made_by"] = fmt::format("plica {} ({})", version(), commit());
  data["begun_by"] = begun.value("plica", "");
  data["processor"] = begun.value("processor", "");
  data["runs"] = design.runs.size();
  data["points"] = fs::absolute(points).lexically_relative(fs::absolute(place).lexically_normal()).generic_string();
  data["columns"] = packed(columns, arrays);
  data["arrays"] = arrays.index();
  return filled_page(study_template(), data["name"].get<std::string>(), data, {{"rows", arrays.bytes()}});
}

void write_study_report(const fs::path& directory) {
  write_file(directory / "report.html", study_report_page(directory, directory));
}

}  // namespace plica
