// Measure sets ([measure] sets): columns that a scenario chooses together. A set is one function: its columns, what it
// keeps over a run (sites, reference values) and how that follows divisions. What is kept is constant between divisions
// and in no checkpoint: a resumed run begins the set again, then calls `follow_division` once, with all divisions as
// one that has no new nodes. columns.cpp lists all sets.
#pragma once

#include <type_traits>

#include "measure/columns.hpp"
#include "measure/furrow.hpp"

namespace plica {

/// Tissue to be measured, with what the scenario describes of it; filled by begin_sets (scenario/setup.cpp).
struct Subject {
  const Model& model;
  FurrowSites furrow = {};                       // without cells if nothing contracts
  bool is_embryo = false;                        // has a ventral side (embryo.axes)
  bool projects = false;                         // volumes are projected
  std::optional<double> exchange_below_um = {};  // of [exchange], if any
  std::string exchange_region = {};
};

inline bool always(const Subject&) { return true; }
inline bool of_embryo(const Subject& subject) { return subject.is_embryo; }

struct MeasureSet {
  std::string_view name;                          // empty: measured in every run
  std::string_view needs;                         // of the tissue; for messages and docs/reference/measures.md
  std::function<std::any(const Subject&)> begin;  // what is kept over the run; empty without what it needs
  std::vector<Column> columns;
  std::function<bool(const Subject&)> is_usual = always;  // whether measured by default
  std::function<void(std::any&, const Tissue&, const TissueChange&)> follow_division = {};
  std::string_view with = {};  // set that is measured along with it
};

/// What a set keeps if it has a value, or that it fits although it keeps nothing.
template <class Kept>
std::any kept_if(const std::optional<Kept>& kept) {
  return kept ? std::any(*kept) : std::any();
}
inline std::any kept_if(bool fits) { return fits ? std::any(true) : std::any(); }

/// Column of a function of the tissue, or the model, and positions.
template <class Result, class Of>
Column::OfStep of(Result (*value)(const Of&, std::span<const Vec3>)) {
  return [=](const ColumnInput& m) -> std::optional<double> {
    if constexpr (std::is_same_v<Of, Model>)
      return value(m.model, m.state.positions);
    else
      return value(m.model.tissue, m.state.positions);
  };
}

/// Column of a part of a value that columns share; none if the value is missing.
template <class Value>
Column::OfStep part_of(Value (*compute)(const ColumnInput&), std::optional<double> Value::*part) {
  return [=](const ColumnInput& m) { return m.once(compute).*part; };
}
template <class Value, class Part>
Column::OfStep part_of(std::optional<Value> (*compute)(const ColumnInput&), Part Value::*part) {
  return [=](const ColumnInput& m) -> std::optional<double> {
    const std::optional<Value>& value = m.once(compute);
    if (!value) return std::nullopt;
    return (*value).*part;
  };
}

/// Set that keeps no places of cells, which divisions would change.
inline MeasureSet set_of(std::string_view name, std::string_view needs, std::function<std::any(const Subject&)> begin,
                         std::vector<Column> columns, std::function<bool(const Subject&)> is_usual = always) {
  return {name, needs, std::move(begin), std::move(columns), std::move(is_usual)};
}

/// All sets; the first is measured in every run.
std::span<const MeasureSet> measure_sets();

/// Start measuring a set and the one along with it. Returns false without what it needs.
bool begin(const MeasureSet& set, const Subject& subject, KeptBySet& kept);

/// Advice to measure the set of a column; empty if `name` is not a column of a set.
std::string set_remedy(std::string_view name);

}  // namespace plica
