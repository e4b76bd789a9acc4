// Measure sets ([measure] sets): columns that a scenario chooses together. A set is one function: its columns, what it
// keeps over a run (sites, reference values) and how that follows divisions. columns.cpp lists all sets.
#pragma once

#include "measure/columns.hpp"
#include "measure/furrow.hpp"

namespace plica {

/// Tissue to be measured, with what the scenario describes of it.
struct Subject {
  const Model& model;
  FurrowSites furrow = {};  // without cells if nothing contracts
  bool is_embryo = false;   // has a ventral side (embryo.axes)
  bool projects = false;    // volumes are projected
};

inline bool of_embryo(const Subject& subject) { return subject.is_embryo; }

struct MeasureSet {
  std::string_view name;     // empty: measured in every run
  std::string_view meaning;  // for docs/reference/measures.md
  std::string_view needs;    // for messages: without it, no column has a value
  std::function<bool(const Subject&)> fits;
  std::vector<Column> columns;
  std::function<std::any(const Subject&)> begin = {};  // what is kept over the run
  std::function<void(std::any&, const Tissue&, const Division&)> follow_division = {};
  std::function<bool(const Subject&)> is_usual = {};  // whether measured by default where it fits; empty: yes
  std::string_view with = {};                         // set that is measured along with it
};

MeasureSet run_set();
MeasureSet fold_set();
MeasureSet furrow_set();
MeasureSet contact_set();
MeasureSet closing_set();
MeasureSet lumen_set();
MeasureSet enclosed_set();
MeasureSet shell_set();
MeasureSet perivitelline_set();
MeasureSet flanks_set();
MeasureSet bending_set();
MeasureSet projection_set();

/// All sets; the first is measured in every run.
std::span<const MeasureSet> measure_sets();

/// Start measuring a set and the one along with it.
void begin(const MeasureSet& set, const Subject& subject, KeptBySet& kept);

/// Advice to measure the set of a column; empty if `name` is not a column of a set.
std::string set_remedy(std::string_view name);

}  // namespace plica
