// Helpers to write a scenario table: its rows (key, member that it fills, allowed values, meaning) and its rules. What
// a table's file has for itself is in a namespace of_FILE, because names such as `build` recur in files that are
// compiled together.
#pragma once

#include <fmt/format.h>

#include <array>
#include <concepts>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "core/units.hpp"
#include "mechanics/active/shape_activation.hpp"
#include "mechanics/model.hpp"
#include "scenario/acting.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/input.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"
#include "tissue/mesh_input.hpp"

namespace plica {

template <class Table>
using Named = std::map<std::string, Table> Scenario::*;

using Errors = std::vector<Diagnostic>;

/// Makes rows of one table, whose keys fill members of a `Table` or of its base.
template <class Table>
struct KeyRows {
  std::string_view path;
  std::function<Table&(Scenario&, const std::string& name)> table;

  template <class Base, class T>
  KeyRow operator()(std::string_view key, T Base::*field, Allowed allowed, std::string_view meaning,
                    KeyOptions options = {}) const {
    const auto slot = [=, table = table](Scenario& scenario, const std::string& name) -> Slot {
      return &(table(scenario, name).*field);
    };
    return {path, key, slot, std::move(allowed), meaning, std::move(options)};
  }

  /// Makes a row of an inner table, or of its base.
  template <class Base, class Inner, class InnerBase, class T>
  KeyRow operator()(std::string_view key, Inner Base::*inner, T InnerBase::*field, Allowed allowed,
                    std::string_view meaning, KeyOptions options = {}) const {
    const auto slot = [=, table = table](Scenario& scenario, const std::string& name) -> Slot {
      return &(table(scenario, name).*inner.*field);
    };
    return {path, key, slot, std::move(allowed), meaning, std::move(options)};
  }
};

template <class Table>
KeyRows<Table> key_rows(std::string_view path, Table Scenario::*table) {
  return {path, [=](Scenario& scenario, const std::string&) -> Table& { return scenario.*table; }};
}

/// Also sets the names of the tables, and the region that each refers to if it has one.
template <class Table>
KeyRows<Table> key_rows(ScenarioTable& info, Named<Table> tables) {
  info.names = [=](const Scenario& scenario) { return keys_of(scenario.*tables); };
  if constexpr (requires(Table table) { table.region; })
    info.regions = [=, stem = info.stem()](const Scenario& scenario, const TakeRegion& take) {
      for (const auto& [name, table] : scenario.*tables) {
        take(fmt::format("{}.{}.region", stem, name), table.region);
        if constexpr (std::derived_from<Table, ActingInput>)
          take(fmt::format("{}.{}.profile.about", stem, name), table.profile.about);
      }
    };
  return {info.path, [=](Scenario& scenario, const std::string& name) -> Table& { return (scenario.*tables)[name]; }};
}

inline const Allowed anything = {};
inline const Allowed positive = {.low = 0, .low_included = false};
inline const Allowed not_negative = {.low = 0};
inline const Allowed positive_or_none = {.low = 0, .low_included = false, .word_for_none = "none"};
constexpr double max_count = 100000;

inline Allowed between(double low, double high) { return {.low = low, .high = high}; }
inline Allowed one_of(std::vector<std::string_view> words) { return {.words = std::move(words)}; }
template <class Meaning, std::size_t n>
Allowed one_of(const std::array<Word<Meaning>, n>& table) {
  return one_of(words_of(table));
}

/// Adds the keys of an activity time course; `keys`: of times in s and in min, and of activities.
template <class Table, class Base>
void add_program(std::vector<KeyRow>& rows, const KeyRows<Table>& table, ProgramInput Base::*program,
                 const std::array<std::string_view, 3>& keys = {"program.time_s", "program.time_min",
                                                                "program.activity"}) {
  rows.push_back(table(keys[0], program, &ProgramInput::time_s, anything,
                       "Times (s), increasing. A time given twice marks a jump, at which a step ends."));
  rows.push_back(table(keys[1], program, &ProgramInput::time_s, anything, "The times in minutes.",
                       {.instead_of = keys[0], .scale = 60}));
  rows.push_back(table(keys[2], program, &ProgramInput::activity, not_negative, "Activity at these times."));
}

/// Adds the keys of an activity that follows a signal.
template <class Table>
void add_follow(std::vector<KeyRow>& rows, const KeyRows<Table>& table) {
  rows.push_back(table("follow.signal", &Table::follow, &FollowInput::signal, anything,
                       "Name of a `[signal.NAME]`; `[cortex.NAME]`: instead of `measure`."));
  rows.push_back(
      table("follow.of", &Table::follow, &FollowInput::of, one_of(words::read_cells), "Whose, as in `trigger.of`."));
  rows.push_back(table("follow.from", &Table::follow, &FollowInput::from, not_negative,
                       "Value at which, and before which, the factor is 0."));
  rows.push_back(table("follow.to", &Table::follow, &FollowInput::to, not_negative,
                       "Value at which, and beyond which, the factor is 1."));
}

/// Adds the keys of amplitude factors (profile and variation) of tables that act.
void add_strengths(std::vector<KeyRow>& rows, const KeyRows<ActingInput>& table);

/// Adds the keys of amplitude factors, activation wave and pulses.
void add_pattern(std::vector<KeyRow>& rows, const KeyRows<ActingInput>& table);

template <class Table>
KeyRows<ActingInput> acting(const KeyRows<Table>& rows) {
  return {rows.path, rows.table};
}

/// Resets `field` to its default. Reports an error if it was set together with, or after, a choice that does not use
/// it.
template <class T>
void drop(const std::string& address, T& field, const T& default_value, const std::string& chooser,
          const std::string& problem, const std::string& remedy, Input& input) {
  if (field != default_value && input.given_with(address, chooser)) input.report(address, problem, remedy);
  field = default_value;
}

/// Drops a key that only one choice of another key uses, likewise.
template <class Table, class T>
void drop_unless_chosen(Table& table, T Table::*field, const std::string& address, const std::string& chooser,
                        const std::string& choice, Input& input) {
  if (input.sound(chooser) && input.sound(address))
    drop(address, table.*field, Table().*field, chooser, fmt::format("is used only with {} = \"{}\"", chooser, choice),
         fmt::format("remove it, or set {} to \"{}\"", chooser, choice), input);
}

/// Number of cells of a shape on a grid. A closed sheet has cells on six sides, a slice on four.
std::int64_t built_cell_count(const EmbryoInput& embryo);

/// Checks a time course of `table` ("contraction.NAME").
void check_program(const std::string& table, const ProgramInput& program, Input& input,
                   const std::string& name = "program");

/// Checks what cells read by the keys of `part` ("cortex.NAME.trigger"), a shape only if it may be one; false: nothing,
/// or an error. `has_bounds`: other keys of the part need it.
bool check_reading(const std::string& part, const ActivationInput& reading, bool has_bounds, const Scenario& scenario,
                   Input& input, bool may_be_shape);
/// Checks `follow` of a table likewise, with its bounds.
bool check_follow(const std::string& table, const FollowInput& follow, const Scenario& scenario, Input& input,
                  bool may_be_shape = false);

/// Make the rule of what cells read, without bounds.
ShapeActivationRule make_reading(const ActivationInput& input, const Scenario& scenario);
/// Unit in which a scenario gives the bounds of what cells read.
inline double reading_unit(const ShapeActivationRule& rule) {
  return rule.measure == ShapeMeasure::passive_stress ? units::pascal : 1;
}
/// Make the rule of an activity that follows it.
ShapeActivationRule make_follow(const FollowInput& input, const Scenario& scenario);

/// Checks program, profile, delay and pulse of `table`: keys that others require or do not use. Sets default axis, wave
/// origin and phase.
void check_acting(const std::string& table, ActingInput& acting, const TimeInput& time, Input& input);

/// Checks each table of one kind by `check`, where `path` is its address ("monitor.NAME").
template <class Table>
void check_each(ScenarioTable& info, Named<Table> tables,
                void (*check)(const std::string& path, Table&, const Scenario&, Input&)) {
  info.rules = [=, stem = info.stem()](Scenario& scenario, Input& input) {
    for (auto& [name, table] : scenario.*tables) check(fmt::format("{}.{}", stem, name), table, scenario, input);
  };
}

/// Lists the tables of one kind that act, and checks what all that act have, then what `check` adds for the kind.
/// `describe` fills what depends on the kind; null: nothing.
template <class Table>
void list_acting(ScenarioTable& info, Named<Table> tables,
                 std::type_identity_t<void (*)(const Table&, const Scenario&, Acting&)> describe,
                 void (*check)(const std::string& path, Table&, const Scenario&, Input&) = nullptr) {
  info.acting = [=, stem = info.stem()](const Scenario& scenario, std::vector<Acting>& all) {
    for (const auto& [name, table] : scenario.*tables) {
      all.push_back({fmt::format("{}.{}", stem, name), table});
      if (describe) describe(table, scenario, all.back());
    }
  };
  info.rules = [=, stem = info.stem()](Scenario& scenario, Input& input) {
    for (auto& [name, table] : scenario.*tables) {
      const std::string path = fmt::format("{}.{}", stem, name);
      check_acting(path, table, scenario.time, input);
      if (check) check(path, table, scenario, input);
    }
  };
}

}  // namespace plica
