#include "study/study_input.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <utility>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/names.hpp"
#include "scenario/builtin.hpp"
#include "scenario/schema.hpp"
#include "scenario/suggest.hpp"
#include "scenario/toml_reader.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

template <class Word, std::size_t count>
using Words = std::array<std::pair<const char*, Word>, count>;

constexpr Words<DesignKind, 7> kinds = {{{"grid", DesignKind::grid},
                                         {"list", DesignKind::list},
                                         {"one-at-a-time", DesignKind::one_at_a_time},
                                         {"sobol", DesignKind::sobol},
                                         {"latin-hypercube", DesignKind::latin_hypercube},
                                         {"sobol-indices", DesignKind::sobol_indices},
                                         {"file", DesignKind::file}}};
constexpr Words<KeptOfRun, 3> kept = {
    {{"row", KeptOfRun::row}, {"summary", KeptOfRun::summary}, {"full", KeptOfRun::full}}};

// Keys of each table; [set] and [vary] have those of the scenario.
const std::map<std::string, std::vector<std::string>, std::less<>> known_keys = {
    {"", {"format", "scenario", "set", "vary", "design", "keep"}},
    {"design", {"kind", "points", "seed", "replicates", "file"}},
    {"keep", {"measures", "each"}}};

class Reader : TomlReader {
 public:
  Reader(StudyInput& study, const toml::table& document) : TomlReader(study.file), study_(study), document_(document) {}

  void read() {
    if (std::ranges::none_of(std::array{"scenario", "vary", "design"},
                             [&](auto name) { return document_.contains(name); }) &&
        !document_.empty())
      throw ScenarioError({{study_.file, 0, "", "is a scenario, not a study",
                            fmt::format("run it with plica run {} --out DIR, or name it in a study", study_.file)}});
    refuse_unknown(document_, "");
    if (const toml::node* format = document_.get("format"); format && format->value<int>() != 1)
      report(*format, "format", "is unknown to this version", "write format = 1");
    read_scenario();
    if (const toml::table* set = table(document_, "set")) read_overrides(*set, study_.overrides, study_.override_lines);
    if (const toml::table* vary = table(document_, "vary")) read_keys(*vary, "");
    read_design();
    read_kept();
    if (diagnostics_.empty()) check_design();
    throw_what_is_wrong();
  }

 private:
  using TomlReader::refuse_unknown;

  // Report unknown keys of a table. A key that another table has is probably misplaced.
  void refuse_unknown(const toml::table& table, const std::string& name) {
    const std::vector<std::string>& known = known_keys.at(name);
    refuse_unknown(table, name.empty() ? "" : name + ".", known, [&](std::string_view key) {
      for (const auto& [other, keys] : known_keys)
        if (std::ranges::count(keys, key) > 0)
          return other.empty() ? std::string("it belongs above all tables") : fmt::format("it belongs in [{}]", other);
      return did_you_mean(key, known);
    });
  }

  void read_scenario() {
    if (!document_.contains("scenario")) report_at(0, "scenario", "is missing", "give a built-in name or a file");
    if (auto found = scenario(document_, "scenario")) study_.scenario = std::move(*found);
  }

  // Keys in their order in the file.
  void read_keys(const toml::table& table, const std::string& before) {
    for (const auto& [name, node] : in_order(table)) {
      const std::string path = before + name;
      if (node->is_table() && !node->as_table()->is_inline())
        read_keys(*node->as_table(), path + ".");
      else
        read_key(path, *node);
    }
  }

  void read_key(const std::string& path, const toml::node& node) {
    const std::string place = "vary." + path;
    StudyKey key;
    key.key = path, key.line = static_cast<int>(node.source().begin.line);
    const KeyRow* row = row_of_key(path);
    key.is_whole = row != nullptr && row->type() == "integer";
    const toml::table* given = node.as_table();
    if (given == nullptr)
      return report(node, place, "no range or values", "give { low = 1, high = 2 } or { values = [1, 2] }");
    const std::vector<std::string> known = {"values", "low", "high", "scale", "step", "count", "mean", "sd"};
    refuse_unknown(*given, place + ".", known);
    if (const toml::node* values = given->get("values")) {
      const toml::array* list = values->as_array();
      if (list == nullptr || list->empty())
        return report(*values, place + ".values", list == nullptr ? "is not a list" : "is empty", "give [1, 2, 3]");
      if (given->size() > 1)
        return report(node, place, "mixes values with other keys",
                      "give either values, or low and high, or mean and sd");
      for (const toml::node& value : *list) key.values.push_back(value_in_toml(value));
      study_.keys.push_back(std::move(key));
      return;
    }
    const std::size_t wrong = diagnostics_.size();
    const auto number = [&](const char* name) { return get<double>(*given, name, place + ".", "a number"); };
    key.mean = number("mean"), key.sd = number("sd"), key.step = number("step");
    key.count = count(*given, "count", place + ".");
    const auto scale = get<std::string>(*given, "scale", place + ".", "\"linear\" or \"log\"");
    key.is_log = scale == "log";
    const bool is_normal = given->contains("mean") || given->contains("sd");
    key.low = number("low").value_or(is_normal ? -infinite : 0);
    key.high = number("high").value_or(is_normal ? infinite : 0);
    if (diagnostics_.size() > wrong) return;

    if (scale && *scale != "log" && *scale != "linear")
      return report(node, place + ".scale", fmt::format("\"{}\" is not a known scale", *scale), "give linear or log");
    if (is_normal && !(key.mean && key.sd && *key.sd > 0))
      return report(node, place, "incomplete normal distribution", "give mean and sd, with sd above 0");
    if (is_normal && (key.is_log || key.step || key.count))
      return report(node, place, "mixes a normal distribution with other keys",
                    "give only mean, sd, and low and high if needed");
    if (!is_normal && !(given->contains("low") && given->contains("high")))
      return report(node, place, "no bounds", "give low and high, or values, or mean and sd");
    if (!(key.low < key.high))
      return report(node, place, "empty range", "give low below high; put a single value into [set]");
    if (key.is_log && key.low <= 0) return report(node, place, "logarithmic scale with low <= 0", "give low above 0");
    if (key.step && !(*key.step > 0 && *key.step <= key.high - key.low))
      return report(node, place + ".step", "not between 0 and high - low", "give a step in this range");
    if (key.step && (key.is_log || key.count))
      return report(node, place, "conflicts: step with count or scale",
                    "give only one of step, count and scale = \"log\"");
    if (key.count == 1)
      return report(node, place + ".count", "is 1, a single value of a range", "give 2 or more, or one value in [set]");
    if (const double rest = key.step ? std::remainder(key.high - key.low, *key.step) : 0;
        std::abs(rest) > 1e-9 * key.high)
      study_.notes.push_back(
          {study_.file, key.line, place + ".step", fmt::format("does not reach high = {:g}", key.high),
           fmt::format("the last value is {:g}", key.low + *key.step * std::floor((key.high - key.low) / *key.step))});
    study_.keys.push_back(std::move(key));
  }

  void read_design() {
    const toml::table* design = table(document_, "design");
    if (design == nullptr) {
      if (!document_.contains("design")) report_at(0, "design", "is missing", "write [design] and kind = \"grid\"");
      return;
    }
    refuse_unknown(*design, "design");
    if (!design->contains("kind"))
      report(*design, "design.kind", "is missing", "give grid, list, one-at-a-time, sobol, latin-hypercube or file");
    study_.kind = word(*design, "kind", "design.", kinds).value_or(DesignKind::grid);
    study_.points = count(*design, "points", "design.").value_or(0);
    study_.replicates = count(*design, "replicates", "design.").value_or(1);
    const auto seed = get<std::int64_t>(*design, "seed", "design.", "a whole number");
    if (seed && *seed < 0) report(*design->get("seed"), "design.seed", "is negative", "give 0 or more");
    study_.seed = static_cast<std::uint64_t>(seed.value_or(1));
    if (const auto file = get<std::string>(*design, "file", "design.", "a text"))
      study_.points_file = (fs::path(study_.file).parent_path() / *file).string();
  }

  void read_kept() {
    const toml::table* keep = table(document_, "keep");
    if (keep == nullptr) return;
    refuse_unknown(*keep, "keep");
    study_.each = word(*keep, "each", "keep.", kept).value_or(KeptOfRun::row);
    const toml::node* measures = keep->get("measures");
    if (measures == nullptr) return;
    const toml::array* list = measures->as_array();
    if (list == nullptr || list->empty())
      return report(*measures, "keep.measures", "is not a list of names", "give [\"furrow_depth_um\"], or remove it");
    for (const toml::node& name : *list) {
      if (!name.is_string())
        return report(name, "keep.measures", "contains an entry that is not a name", "give names in quotes");
      study_.measures.push_back(name.as_string()->get());
    }
  }

  // Check the keys that the kind of design requires or ignores.
  void check_design() {
    const toml::table& design = *document_.get("design")->as_table();
    const bool draws = study_.kind == DesignKind::sobol || study_.kind == DesignKind::latin_hypercube ||
                       study_.kind == DesignKind::sobol_indices;
    const bool is_of_file = study_.kind == DesignKind::file;
    if (draws && study_.points == 0)
      report(design, "design.points", "is missing", "give the number of points to sample");
    if (!draws && study_.points > 0)
      report(*design.get("points"), "design.points", "unused: the keys determine the number of points", "remove it");
    if (!draws && design.contains("seed"))
      report(*design.get("seed"), "design.seed", "unused: nothing is sampled", "remove it");
    if (is_of_file && study_.points_file.empty())
      report(design, "design.file", "is missing", "name a CSV file with one column per key");
    if (!is_of_file && !study_.points_file.empty())
      report(*design.get("file"), "design.file", "unused by this kind", "remove it, or write kind = \"file\"");
    if (is_of_file && !study_.keys.empty())
      report_at(study_.keys.front().line, "vary", "unused: the file has the values", "remove it");
    if (!is_of_file && study_.keys.empty())
      report_at(0, "vary", "is empty", "give the keys to vary: [vary] \"a.key\" = { values = [1, 2] }");
    for (const StudyKey& key : study_.keys) check_key(key, draws);
  }

  void check_key(const StudyKey& key, bool draws) {
    const std::string place = "vary." + key.key;
    for (const std::string& override : study_.overrides)
      if (override.starts_with(key.key + "="))
        report_at(key.line, place, "conflicts with [set], which fixes it", "remove one of the two");
    if (draws) {
      if (key.count) report_at(key.line, place + ".count", "unused: values are sampled", "remove it");
      return;
    }
    if (study_.kind == DesignKind::list) {
      const std::size_t others = study_.keys.front().values.size();
      if (key.values.empty())
        report_at(key.line, place, "no values", "give { values = [...] } for every key of a list");
      else if (key.values.size() != others)
        report_at(
            key.line, place,
            fmt::format("has {} values, and {} has {}", key.values.size(), study_.keys.front().key, others),
            "give equally many for every key: a list takes the first of each, then the second of each, and so on");
      return;
    }
    if (key.values.empty() && !key.step && !key.count)
      report_at(key.line, place, "no values", "give values, or low and high with count or step");
  }

  StudyInput& study_;
  const toml::table& document_;
};

}  // namespace

const char* word_of(DesignKind kind) {
  return std::ranges::find(kinds, kind, &decltype(kinds)::value_type::second)->first;
}

bool is_study(const std::string& text) {
  try {
    const toml::table document = toml::parse(text);
    return document.contains("design") || document.contains("vary");
  } catch (const toml::parse_error&) {
    return false;
  }
}

StudyInput parse_study(const std::string& name, const std::string& file, const std::string& text) {
  StudyInput study;
  study.name = name, study.file = file, study.text = text;
  const toml::table document = parse_toml(file, text);
  Reader(study, document).read();
  return study;
}

StudyInput read_study(const std::string& file) {
  if (!is_there(file) && std::ranges::count(names_of(builtin_scenarios()), file) > 0)
    throw UsageError(fmt::format("{0}: is a scenario, not a study; run it with plica run {0} --out DIR", file));
  return parse_study(fs::path(file).stem().string(), file, read_file(file));
}

}  // namespace plica
