#include "scenario/load.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "core/files.hpp"
#include "core/names.hpp"
#include "scenario/builtin.hpp"
#include "scenario/read_layer.hpp"
#include "scenario/setup.hpp"
#include "scenario/suggest.hpp"
#include "scenario/toml_reader.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

struct Document {
  ScenarioSource source;
  toml::table table;
};

/// Finds the scenario that `base` of `document` names. Returns nothing, after reporting, if it cannot be found.
std::optional<ScenarioSource> find_base(const Document& document, const std::vector<Document>& chain,
                                        std::vector<Diagnostic>& diagnostics) {
  const toml::node* base = document.table.get("base");
  const auto name = base == nullptr ? std::nullopt : base->value_exact<std::string>();
  if (!name) return {};  // absent, or of a wrong type, which reading the layer reports
  const int line = static_cast<int>(base->source().begin.line);
  const auto report = [&](const std::string& problem, const std::string& remedy) {
    diagnostics.push_back({document.source.file, line, "base", problem, remedy});
  };
  try {
    const bool is_builtin = std::ranges::count(names_of(builtin_scenarios()), *name) > 0;
    ScenarioSource found =
        find_scenario(is_builtin ? *name : (fs::path(document.source.file).parent_path() / *name).string());
    const auto same = [&](const Document& other) {
      return fs::path(other.source.file).lexically_normal() == fs::path(found.file).lexically_normal() &&
             other.source.text == found.text;
    };
    if (std::ranges::none_of(chain, same)) return found;
    report(fmt::format("\"{}\" inherits from itself through its bases", *name), "remove one base of the cycle");
  } catch (const UsageError& error) {
    report(error.what(), "set base to a built-in name or a path relative to this file");
  } catch (const FileError& error) {
    report(error.what(), "set base to a built-in name or a path relative to this file");
  }
  return {};
}

/// Reports a file of cells in place of a scenario.
void refuse_mesh(const std::string& file) {
  constexpr std::array endings = {".vtp", ".vtk", ".vtu", ".ply", ".obj", ".off", ".stl", ".h5", ".hdf5", ".hf5"};
  const fs::path path(file);
  if (std::ranges::count(endings, path.extension().string()) == 0) return;
  throw ScenarioError({{file, 0, "", "is a mesh, not a scenario",
                        fmt::format("write a scenario with [embryo], file = \"{}\" and its shape: \"prisms\" if plica "
                                    "labels made it, \"surface\" for polygons, \"file\" for hexahedra",
                                    path.filename().string())}});
}

/// Reads the scenario and its bases, the deepest first. Incomplete if an error was reported.
std::vector<Document> read_documents(const ScenarioSource& source, std::vector<Diagnostic>& diagnostics) {
  std::vector<Document> chain;
  for (std::optional<ScenarioSource> next = source; next;) {
    try {
      chain.push_back({*next, parse_toml(next->file, next->text)});
      const toml::table& table = chain.back().table;
      const bool is_study = table.contains("vary") && table.contains("design");
      if (is_study || table.contains("experiment")) {
        diagnostics.push_back({next->file, 0, "",
                               is_study ? "is a study, not a scenario" : "contains experiments, not a scenario",
                               fmt::format("run {} with plica {} {} --out DIR", is_study ? "it" : "them",
                                           is_study ? "study" : "reproduce", next->file)});
        chain.clear();
        break;
      }
      next = find_base(chain.back(), chain, diagnostics);
      if (next && chain.size() == most_bases) {
        diagnostics.push_back({chain.back().source.file, 0, "base", "too many scenarios inherit from one another",
                               fmt::format("use at most {}", most_bases)});
        break;
      }
    } catch (const ScenarioError& error) {
      diagnostics.push_back(error.diagnostics().front());
      break;
    }
  }
  std::ranges::reverse(chain);
  return chain;
}

/// Whether the key takes a text, whose quotes the shell may have removed.
bool takes_text(const std::string& key) {
  const KeyRow* row = row_of_key(key);
  const std::string type = row == nullptr ? "" : row->type();
  return type == "text" || type == "word";
}

/// Parses a value in TOML, or a text without quotes; nothing if it is neither.
std::optional<toml::table> parse_value(const std::string& key, const std::string& value) {
  toml::table document;
  try {
    document = toml::parse("v = " + value);
    if (document.size() != 1) return {};
    const toml::node& node = *document.get("v");
    if (node.is_string() || !node.is_value() || !takes_text(key)) return document;
  } catch (const toml::parse_error&) {
    const auto in_bare_word = [](char c) { return is_plain_name({&c, 1}) || c == '.' || c == '/'; };
    const bool is_broken = value.empty() || std::string_view("\"'[{").find(value.front()) != std::string_view::npos;
    if (is_broken || (!takes_text(key) && !std::ranges::all_of(value, in_bare_word))) return {};
  }
  document.insert_or_assign("v", value);
  return document;
}

/// Converts "dotted.key=value" to a TOML document; nothing if it cannot be parsed.
std::optional<toml::table> parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || line_of_too_deep_key(text) > 0) return {};
  const std::string key = trimmed(text.substr(0, equals)), value = trimmed(text.substr(equals + 1));
  std::optional<toml::table> document = parse_value(key, value);
  if (!document) return {};
  // The innermost key gets the value; each further key a table around it.
  const std::size_t last = key.rfind('.');
  toml::table nested;
  nested.insert_or_assign(last == std::string::npos ? key : key.substr(last + 1), std::move(*document->get("v")));
  for (std::size_t end = last; end != std::string::npos;) {
    const std::size_t dot = end == 0 ? std::string::npos : key.rfind('.', end - 1);
    const std::size_t begin = dot == std::string::npos ? 0 : dot + 1;
    nested = toml::table{{key.substr(begin, end - begin), std::move(nested)}};
    end = dot;
  }
  return nested;
}

void read_overrides(const std::vector<std::string>& overrides, int layer, Scenario& scenario, Input& input) {
  for (const std::string& text : overrides) {
    const std::string key = trimmed(text.substr(0, text.find('=')));
    const auto table = parse_override(text);
    if (!table) {
      input.diagnostics.push_back(
          {"--set", 0, key, "cannot be parsed",
           "write dotted.key=value with a TOML value: a number with a decimal point and no unit, or a word"});
    } else if (table->contains("base")) {
      input.diagnostics.push_back(
          {"--set", 0, "base", "base cannot be set on the command line", "write base in the scenario's file"});
    } else {
      read_layer(*table, {"--set", layer, false}, scenario, input);
    }
  }
}

void forget_expectations(Scenario& scenario, Input& input) {
  scenario.expect.clear();
  std::erase_if(input.places, [](const auto& place) { return place.first.starts_with("expect."); });
}

/// Suggests a built-in, or a file in the folder of the path, with a similar name.
std::string nearest_scenario(const fs::path& path, const fs::path& beside) {
  std::vector<std::string> files;
  const fs::path folder = (beside / path).parent_path();
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, error))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().filename().string());
  std::ranges::sort(files);
  if (const auto nearest = nearest_name(path.filename().string(), files); nearest && path.extension() == ".toml")
    return fmt::format("use \"{}\" (nearest match)", (path.parent_path() / *nearest).string());
  return did_you_mean(path.stem().string(), names_of(builtin_scenarios()));
}

/// Sorts by source, then by line.
void sort_diagnostics(std::vector<Diagnostic>& diagnostics, const std::vector<Document>& documents) {
  const auto rank = [&](const Diagnostic& diagnostic) {
    const auto has_file = [&](const Document& document) { return document.source.file == diagnostic.file; };
    return std::pair(std::ranges::find_if(documents, has_file) - documents.begin(), diagnostic.line);
  };
  std::ranges::stable_sort(diagnostics, {}, rank);
}

/// Replaces "automatic" by the value that fits the scenario. Call on a valid scenario.
void resolve_automatic(Scenario& scenario) {
  const bool may_invert = !is_of_grid(shape_of(scenario.embryo)) || !scenario.divisions.empty();
  if (!scenario.elasticity.corner_barrier_Pa)
    scenario.elasticity.corner_barrier_Pa =
        may_invert && !is_as_in_the_paper(scenario) ? scenario.elasticity.young_modulus_Pa / 10 : 0;
  if (scenario.time.integrator == "automatic")
    scenario.time.integrator = what_bars_second_order(scenario).empty() ? "bdf2" : "backward-euler";
}

void check_required_keys(const ScenarioTable& info, const Scenario& scenario, Input& input) {
  const std::vector<std::string> names = info.named() ? info.names(scenario) : std::vector<std::string>();
  for (const std::string& name : names) {
    const std::string path = fmt::format("{}.{}", info.stem(), name);
    for (const KeyRow& row : info.rows) {
      const std::string address = fmt::format("{}.{}", path, row.key);
      if (!row.options.required || !input.sound(path) || input.place(address) != nullptr) continue;
      // A misspelt table name is a frequent cause.
      std::vector<std::string> others = names;
      std::erase(others, name);
      const std::optional<std::string> meant = nearest_name(name, others);
      input.report(
          address, "is missing",
          row.remedy() +
              (meant ? fmt::format(", or rename the table to {}.{} (nearest match)", info.stem(), *meant) : ""));
    }
  }
}

void check_region(const std::string& address, const std::string& region, const Scenario& scenario, Input& input) {
  if (region.empty() || region == "all" || scenario.regions.contains(region)) return;
  if (!input.sound("region") || !input.sound(address)) return;
  if (!input.sound("region." + region)) return;  // not read; already reported
  std::vector<std::string> names = keys_of(scenario.regions);
  names.insert(names.begin(), "all");
  std::string remedy = did_you_mean(region, names);
  if (input.sound("embryo.shape") && is_from_file(shape_of(scenario.embryo)))
    remedy += fmt::format("; if it is an array of the file, add [region.{0}] with array = \"{0}\"", region);
  input.report(address, fmt::format("region \"{}\" does not exist", region), remedy);
}

/// Reports inconsistent keys to `input` and sets defaults that depend on other keys: fields that the embryo's shape
/// does not use, the length of a sphere (its diameter), the vitelline membrane of a block (none), values that are
/// "automatic".
void validate(Scenario& scenario, Input& input) {
  for (const ScenarioTable& table : scenario_tables()) check_required_keys(table, scenario, input);
  for (const ScenarioTable& table : scenario_tables())
    if (table.rules) table.rules(scenario, input);
  const auto check = [&](const std::string& address, const std::string& region) {
    check_region(address, region, scenario, input);
  };
  for (const ScenarioTable& table : scenario_tables())
    if (table.regions) table.regions(scenario, check);
  if (input.diagnostics.empty()) resolve_automatic(scenario);
}

}  // namespace

ScenarioSource find_scenario(const std::string& name_or_path, const fs::path& beside) {
  for (const BuiltinScenario& scenario : builtin_scenarios()) {
    if (scenario.name == name_or_path) return {name_or_path, name_or_path, std::string(scenario.toml)};
  }
  const fs::path path(name_or_path);
  if (!is_there(path))
    throw UsageError(fmt::format("\"{}\" is neither a built-in scenario nor a file; {}", name_or_path,
                                 nearest_scenario(path, beside)));
  refuse_mesh(name_or_path);
  return {path.stem().string(), name_or_path, read_file(path, largest_scenario_bytes)};
}

std::vector<Diagnostic> problems_of_override(const std::string& override) {
  Scenario scenario;
  Input input;
  read_overrides({override}, 0, scenario, input);
  return input.diagnostics;
}

Scenario load_scenario(const ScenarioSource& source, const std::vector<std::string>& overrides) {
  Scenario scenario;
  scenario.name = source.name;
  scenario.file = source.file;
  Input input;
  input.file = source.file;
  const std::vector<Document> documents = read_documents(source, input.diagnostics);
  const bool complete = input.diagnostics.empty();

  int layer = 0;
  for (const Document& document : documents) {
    read_layer(document.table, {document.source.file, layer++, true}, scenario, input);
    if (std::ranges::count(names_of(builtin_scenarios()), document.source.file) == 0) continue;
    scenario.builtin = document.source.file;
    // Expectations of a built-in apply to the unmodified built-in only.
    if (&document != &documents.back() || !overrides.empty()) forget_expectations(scenario, input);
  }
  read_overrides(overrides, layer, scenario, input);
  // A missing base would cause follow-up errors.
  if (complete) validate(scenario, input);

  if (!input.diagnostics.empty()) {
    sort_diagnostics(input.diagnostics, documents);
    throw ScenarioError(std::move(input.diagnostics));
  }
  for (const auto& [address, place] : input.places) scenario.given_at[address] = {place.file, place.line};
  set_default_shell(scenario);
  return scenario;
}

}  // namespace plica
