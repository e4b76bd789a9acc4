#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <optional>
#include <stdexcept>

#include "core/files.hpp"
#include "core/names.hpp"
#include "experiments/experiments.hpp"
#include "scenario/builtin.hpp"
#include "scenario/read_layer.hpp"
#include "scenario/suggest.hpp"
#include "scenario/toml_reader.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr std::array<std::pair<const char*, Role>, 4> roles = {
    {{"predicted", Role::predicted}, {"selected", Role::selected}, {"seen", Role::seen}, {"fitted", Role::fitted}}};
constexpr std::array<std::pair<const char*, Judgement>, 4> judgements = {{{"hit", Judgement::hit},
                                                                          {"miss", Judgement::miss},
                                                                          {"undecided", Judgement::undecided},
                                                                          {"not solved", Judgement::not_solved}}};
constexpr std::array<std::pair<const char*, bool>, 2> kinds = {{{"predictions", false}, {"claims", true}}};
constexpr std::array predictions = {judgements[0], judgements[1], judgements[2]};

// Descriptive keys of an experiment, and of an outcome that has its own.
const std::vector<std::string> told_keys = {"question", "observed", "source", "role", "prediction", "because"};

std::vector<std::string> with_told_keys(std::vector<std::string> keys) {
  keys.insert(keys.end(), told_keys.begin(), told_keys.end());
  return keys;
}

const BuiltinFile* builtin_file(const fs::path& path) {
  const auto& files = builtin_experiment_files();
  const auto found = std::ranges::find(files, path.generic_string(), &BuiltinFile::path);
  return found == files.end() ? nullptr : &*found;
}

class Reader : TomlReader {
 public:
  explicit Reader(Experiments& result) : TomlReader(result.file), result_(result) {}

  void read(const toml::table& document) {
    if (!document.contains("experiment"))
      throw ScenarioError({{result_.file, 0, "", "no experiments", "write [experiment.NAME] and its outcomes"}});
    refuse_unknown(document, "", {"format", "title", "kind", "scenario", "draws", "quantity", "experiment"});
    if (const toml::node* format = document.get("format"); format && format->value<int>() != 1)
      report(*format, "format", "is unknown to this version", "write format = 1");
    result_.title = get<std::string>(document, "title", "", "a text").value_or(result_.name);
    result_.are_of_claims = word(document, "kind", "", kinds).value_or(false);
    read_quantities(document);
    has_usual_scenario_ = document.contains("scenario");
    usual_scenario_ = scenario_beside(document, "");
    read_draws(document);
    const toml::table* all = table(document, "experiment");
    if (all != nullptr && all->empty())
      report_at(0, "experiment", "is empty", "write [experiment.NAME] and its outcomes");
    if (all != nullptr) {
      for (const auto& [name, node] : in_order(*all)) names_.push_back(name);
      for (const auto& [name, node] : in_order(*all)) read_experiment(name, *node);
    }
    if (diagnostics_.empty()) check_comparisons();
    throw_what_is_wrong();
  }

 private:
  // Files beside built-in experiments are built in, too.
  std::optional<ScenarioSource> scenario_beside(const toml::table& in, const std::string& before) {
    const auto name = in["scenario"].value_exact<std::string>();
    const fs::path path = fs::path(result_.file).parent_path() / name.value_or("");
    if (const BuiltinFile* file = name ? builtin_file(path) : nullptr)
      return ScenarioSource{path.stem().string(), path.generic_string(), std::string(file->text)};
    return scenario(in, "scenario", before);
  }

  void read_draws(const toml::table& document) {
    result_.draws.runs = {{1, 1, {}, {}}};
    const auto name = get<std::string>(document, "draws", "", "a text");
    if (!name) return;
    const fs::path path = fs::path(result_.file).parent_path() / *name;
    result_.draws_file = path.generic_string();
    try {
      const BuiltinFile* file = builtin_file(path);
      result_.draws = design_of_points(result_.draws_file, file != nullptr ? std::string(file->text) : read_file(path));
    } catch (const ScenarioError& error) {
      diagnostics_.insert(diagnostics_.end(), error.diagnostics().begin(), error.diagnostics().end());
    } catch (const FileError& error) {
      report(*document.get("draws"), "draws", error.what(),
             "name a CSV file beside this one: keys, then one line per draw");
    }
  }

  // Named formulas, each of which may use those before it.
  void read_quantities(const toml::table& document) {
    const toml::table* all = table(document, "quantity");
    if (all == nullptr) return;
    for (const auto& [name, node] : in_order(*all))
      if (const auto text = get<std::string>(*all, name.c_str(), "quantity.", "a text"))
        named_[name] = formula(*text, *node, "quantity." + name);
  }

  Formula formula(const std::string& text, const toml::node& node, const std::string& place) {
    try {
      return Formula(text, named_);
    } catch (const std::invalid_argument& problem) {
      report(node, place, problem.what(),
             "write names of numbers, with operators between spaces, as \"lumen_volume_ratio - 1\"");
      return {};
    }
  }

  // Names become file names.
  void require_name(const toml::node& node, const std::string& name, const std::string& place) {
    if (!is_plain_name(name)) report(node, place, "is not a valid name", "use letters, digits, \"_\" and \"-\"");
  }

  void read_experiment(const std::string& name, const toml::node& node) {
    const std::string before = "experiment." + name + ".";
    require_name(node, name, "experiment." + name);
    const toml::table* given = node.as_table();
    if (given == nullptr)
      return report(node, "experiment." + name, "is not a table", fmt::format("write [experiment.{}]", name));
    refuse_unknown(*given, before, with_told_keys({"scenario", "set", "draws", "drawn", "slow", "outcome"}));
    Experiment experiment;
    experiment.name = name;
    experiment.drawn = get<bool>(*given, "drawn", before, "true or false").value_or(true);
    if (!experiment.drawn && given->contains("draws"))
      report(*given->get("draws"), before + "draws", "conflicts with drawn = false, which makes one run", "remove it");
    read_scenario(*given, before, experiment);
    experiment.draws = experiment.drawn ? result_.draws.runs.size() : 1;
    if (const auto most = count(*given, "draws", before))
      experiment.draws = std::min(experiment.draws, static_cast<std::size_t>(*most));
    experiment.slow = get<bool>(*given, "slow", before, "true or false").value_or(false);
    Outcome none;
    if (result_.are_of_claims) none.role = Role::seen;
    const Outcome usual = read_description(*given, before, none);
    const toml::table* outcomes = table(*given, "outcome", before);
    if (outcomes == nullptr || outcomes->empty())
      report(node, before + "outcome", "is missing",
             fmt::format("write [{}outcome.NAME] with quantity and hit", before));
    if (outcomes != nullptr)
      for (const auto& [key, one] : in_order(*outcomes)) read_outcome(key, *one, before, usual, experiment);
    result_.experiments.push_back(std::move(experiment));
  }

  void read_scenario(const toml::table& given, const std::string& before, Experiment& experiment) {
    StudyInput& study = experiment.study;
    study.file = result_.file;
    std::optional<ScenarioSource> found = given.contains("scenario") ? scenario_beside(given, before) : usual_scenario_;
    if (found)
      study.scenario = std::move(*found);
    else if (!given.contains("scenario") && !has_usual_scenario_)
      report(given, before + "scenario", "is missing", "give a built-in name or a file beside this one");
    if (const toml::table* set = table(given, "set", before))
      read_overrides(*set, study.overrides, study.override_lines);
    if (!experiment.drawn) return;
    for (const std::string& key : result_.draws.keys) {
      study.keys.emplace_back();
      study.keys.back().key = key;
    }
  }

  // Read the descriptive keys of an experiment or outcome; `usual` supplies missing ones. All belong to a question.
  Outcome read_description(const toml::table& given, const std::string& before, const Outcome& usual) {
    Outcome described = usual;
    if (given.contains("question")) described = Outcome(), described.role = usual.role;
    const auto take = [&](const char* key, std::string& text) {
      if (auto found = get<std::string>(given, key, before, "a text")) text = std::move(*found);
    };
    take("question", described.question), take("observed", described.observed), take("source", described.source);
    take("because", described.because);
    if (const auto role = word(given, "role", before, roles)) described.role = *role;
    if (const auto prediction = word(given, "prediction", before, predictions)) described.prediction = prediction;
    return described;
  }

  void read_outcome(const std::string& name, const toml::node& node, const std::string& of_experiment,
                    const Outcome& usual, Experiment& experiment) {
    const std::string place = of_experiment + "outcome." + name, before = place + ".";
    const toml::table* given = node.as_table();
    if (given == nullptr)
      return report(node, place, "is not a table",
                    fmt::format("outcomes have names: write [{}outcome.NAME]", of_experiment));
    require_name(node, name, place);
    refuse_unknown(*given, before,
                   with_told_keys({"quantity", "over", "minus", "other_quantity", "hit", "undecided", "hit_if_none"}));
    Outcome outcome = read_description(*given, before, usual);
    outcome.name = name, outcome.line = static_cast<int>(node.source().begin.line);
    if (outcome.question.empty())
      report(node, before + "question", "is missing", "give it as a sentence, here or for the whole experiment");
    if (outcome.role == Role::predicted && !outcome.prediction)
      report(node, before + "prediction", "is missing",
             "give the result you predict before the run: hit, miss or undecided; or another role");
    if (auto quantity = get<std::string>(*given, "quantity", before, "a text"))
      outcome.quantity = *quantity, outcome.formula = formula(*quantity, *given->get("quantity"), before + "quantity");
    else if (!given->contains("quantity"))
      report(node, before + "quantity", "is missing", "give a number of summary.json, as \"furrow_depth_um\"");
    read_hit(node, *given, before, outcome);
    read_comparison(*given, before, outcome);
    experiment.outcomes.push_back(std::move(outcome));
  }

  void read_hit(const toml::node& node, const toml::table& given, const std::string& before, Outcome& outcome) {
    outcome.hit_if_none = get<bool>(given, "hit_if_none", before, "true or false").value_or(false);
    outcome.margin = get<double>(given, "undecided", before, "a number").value_or(0);
    if (outcome.margin < 0) report(*given.get("undecided"), before + "undecided", "is negative", "give 0 or more");
    const toml::node* hit = given.get("hit");
    if (hit == nullptr && outcome.hit_if_none) return;
    if (hit == nullptr)
      return report(node, before + "hit", "is missing", "give [from, to]; -inf and inf mean unbounded");
    const toml::array* bounds = hit->as_array();
    const bool is_pair =
        bounds != nullptr && bounds->size() == 2 && bounds->get(0)->is_number() && bounds->get(1)->is_number();
    if (!is_pair)
      return report(*hit, before + "hit", "is not a pair of numbers", "give [from, to]; -inf and inf mean unbounded");
    outcome.low = bounds->get(0)->value<double>().value_or(0);
    outcome.high = bounds->get(1)->value<double>().value_or(0);
    if (!(outcome.low <= outcome.high))
      report(*hit, before + "hit", "is an empty range", "give the smaller number first");
  }

  void read_comparison(const toml::table& given, const std::string& before, Outcome& outcome) {
    if (given.contains("over") && given.contains("minus"))
      return report(*given.get("minus"), before + "minus", "conflicts with over", "remove one of the two");
    const char* key = given.contains("over") ? "over" : "minus";
    const auto name = get<std::string>(given, key, before, "a text");
    const auto there = get<std::string>(given, "other_quantity", before, "a text");
    if (there && !name)
      report(*given.get("other_quantity"), before + "other_quantity", "applies only with over or minus", "remove it");
    if (!name) return;
    outcome.other_quantity = there.value_or("");
    outcome.other_formula =
        there ? formula(*there, *given.get("other_quantity"), before + "other_quantity") : outcome.formula;
    outcome.comparing = key == std::string("over") ? Comparing::ratio : Comparing::difference;
    outcome.compared_with = static_cast<std::size_t>(std::ranges::find(names_, *name) - names_.begin());
    if (outcome.compared_with == names_.size())
      report(*given.get(key), before + key, fmt::format("\"{}\" is not an experiment of this file", *name),
             did_you_mean(*name, names_));
    else if (outcome.compared_with == result_.experiments.size())
      report(*given.get(key), before + key, "is the experiment itself", "name another");
  }

  // Check that for every draw of an experiment the one it is compared with is run, too.
  void check_comparisons() {
    for (const Experiment& experiment : result_.experiments)
      for (const Outcome& outcome : experiment.outcomes) {
        if (outcome.comparing == Comparing::nothing) continue;
        const Experiment& other = result_.experiments[outcome.compared_with];
        const std::string key = fmt::format("experiment.{}.outcome.{}", experiment.name, outcome.name);
        if (other.draws < experiment.draws)
          report_at(outcome.line, key,
                    fmt::format("is compared with {}, which has {} draws instead of {}", other.name, other.draws,
                                experiment.draws),
                    fmt::format("give {} as many draws", other.name));
        if (other.slow && !experiment.slow)
          report_at(outcome.line, key,
                    fmt::format("is compared with {}, which is slow, but is not slow itself", other.name),
                    "mark both as slow, or neither");
      }
  }

  Experiments& result_;
  bool has_usual_scenario_ = false;
  std::optional<ScenarioSource> usual_scenario_;
  std::vector<std::string> names_;
  std::map<std::string, Formula> named_;
};

}  // namespace

const char* word_of(Role role) { return std::ranges::find(roles, role, &decltype(roles)::value_type::second)->first; }

const char* word_of(Judgement judgement) {
  return std::ranges::find(judgements, judgement, &decltype(judgements)::value_type::second)->first;
}

Experiments parse_experiments(const std::string& name, const std::string& file, const std::string& text) {
  Experiments experiments;
  experiments.name = name, experiments.file = file, experiments.text = text;
  Reader(experiments).read(parse_toml(file, text));
  return experiments;
}

Experiments read_experiments(const std::string& name_or_file) {
  if (const BuiltinFile* file = builtin_file(fs::path(name_or_file) / "experiments.toml"))
    return parse_experiments(name_or_file, std::string(file->path), std::string(file->text));
  if (!is_there(name_or_file))
    throw UsageError(fmt::format(
        "\"{}\": not a file or built-in experiments; give paper, living, or a file of experiments", name_or_file));
  return parse_experiments(fs::path(name_or_file).stem().string(), name_or_file, read_file(name_or_file));
}

}  // namespace plica
