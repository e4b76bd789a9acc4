// Change of a tissue's topology: what became of its cells, walls and nodes. Division, exchange, kept part and mirror
// side each return one, and data follow it: by cell (ByCell, follow), by node (with_new_nodes), or by a rule of their
// own.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Free nodes that stay keep their order; new ones follow. One daughter takes the place of the mother among the cells,
/// the other follows at the end.
struct TissueChange {
  std::vector<CellId> origin;                               // cells now; the former cell of each
  std::vector<std::array<CellId, 2>> daughters;             // cuts
  CellSet remeshed = {};                                    // cells now; with other rest shapes; empty: none
  std::vector<WallId> wall_origin;                          // walls now; the former wall of each, invalid: it is new
  std::vector<NodeId> node_origin;                          // free nodes that stay; the former node of each
  std::vector<NodeMean> new_nodes;                          // position of each, by nodes before it
  std::map<std::pair<NodeId, NodeId>, NodeId> node_midway;  // nodes that split an edge, by its ordered ends

  [[nodiscard]] bool is_remeshed(CellId cell) const { return !remeshed.empty() && remeshed[cell.index()]; }
  /// Number of free nodes that stay: the first new node.
  [[nodiscard]] std::size_t kept_nodes() const { return node_origin.size(); }
};

/// Return a change in which everything stays.
TissueChange no_change(const Tissue& tissue);

/// Return values per cell, inherited from its origin.
template <class Values>
Values inherited(const TissueChange& change, const Values& values) {
  Values result;
  result.reserve(change.origin.size());
  for (const CellId origin : change.origin) result.push_back(values[origin.index()]);
  return result;
}

/// Let values follow a change: what is kept by cell (none: it stays so), and such values among the parts of a class, in
/// lists and in maps.
template <class Value>
void follow(const TissueChange& change, ByCell<Value>& values) {
  if (!values.empty()) values = inherited(change, values);
}
template <class Value>
requires requires(Value& value) { Value::parts_by_cell(value); }
void follow(const TissueChange& change, Value& value) {
  std::apply([&](auto&... part) { (follow(change, part), ...); }, Value::parts_by_cell(value));
}
template <class Value>
void follow(const TissueChange& change, std::vector<Value>& values) {
  for (Value& value : values) follow(change, value);
}
template <class Value>
void follow(const TissueChange& change, std::map<std::string, Value>& values) {
  for (auto& [name, value] : values) follow(change, value);
}

/// Return the former number of each facet of one side, by facets before the change, where its cell keeps its facets:
/// it is not remeshed, is no daughter and has as many as before. Facets of a cell are contiguous.
std::vector<std::optional<std::size_t>> former_facets(const TissueChange& change, std::size_t cells_before,
                                                      std::span<const Facet> before, std::span<const Facet> after);

/// Return the first facet of each cell, and the end.
std::vector<std::size_t> first_facets(std::span<const Facet> facets, std::size_t cells);

/// Return vectors per free node before the change, laid out for the tissue after it, with new and hanging nodes placed.
Vectors with_new_nodes(const Tissue& tissue, const TissueChange& change, const Vectors& before);

}  // namespace plica
