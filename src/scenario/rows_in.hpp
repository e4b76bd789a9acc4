// Helpers to write rows of the key table: key, member that it fills, allowed values, meaning.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenario/schema.hpp"
#include "scenario/words.hpp"

namespace plica {

template <class Table>
using Named = std::map<std::string, Table> Scenario::*;

/// Makes rows of one table, whose keys fill members of a `Table`.
template <class Table>
struct RowsIn {
  std::string_view path;
  std::function<Table&(Scenario&, const std::string& name)> table;

  template <class T>
  Row operator()(std::string_view key, T Table::*field, Allowed allowed, std::string_view meaning,
                 RowOptions options = {}) const {
    const auto slot = [=, table = table](Scenario& scenario, const std::string& name) -> Slot {
      return &(table(scenario, name).*field);
    };
    return {path, key, slot, std::move(allowed), meaning, std::move(options)};
  }

  /// Makes a row of an inner table.
  template <class Inner, class T>
  Row operator()(std::string_view key, Inner Table::*inner, T Inner::*field, Allowed allowed, std::string_view meaning,
                 RowOptions options = {}) const {
    const auto slot = [=, table = table](Scenario& scenario, const std::string& name) -> Slot {
      return &(table(scenario, name).*inner.*field);
    };
    return {path, key, slot, std::move(allowed), meaning, std::move(options)};
  }
};

template <class Table>
RowsIn<Table> rows_in(std::string_view path, Table Scenario::*table) {
  return {path, [=](Scenario& scenario, const std::string&) -> Table& { return scenario.*table; }};
}

template <class Table>
RowsIn<Table> rows_in(std::string_view path, Named<Table> tables) {
  return {path, [=](Scenario& scenario, const std::string& name) -> Table& { return (scenario.*tables)[name]; }};
}

inline const Allowed anything = {};
inline const Allowed positive = {.low = 0, .low_included = false};
inline const Allowed not_negative = {.low = 0};

inline Allowed between(double low, double high) { return {.low = low, .high = high}; }
inline Allowed one_of(std::vector<std::string_view> words) { return {.words = std::move(words)}; }
template <class Meaning, std::size_t n>
Allowed one_of(const std::array<Word<Meaning>, n>& table) {
  return one_of(words_of(table));
}

/// Rows of the force laws: elasticity, contraction, cortex, enclosed volume, self-contact, pressure, ablation.
std::vector<Row> law_rows();

}  // namespace plica
