#include "mechanics/model_memory.hpp"

#include <map>
#include <set>
#include <utility>

#include "core/number_list.hpp"
#include "tissue/division.hpp"
#include "tissue/mesh_input.hpp"
#include "tissue/mesher.hpp"

namespace plica {
namespace {

void require(bool fits) {
  if (!fits) throw InvalidNumbers();
}

// Bounds the size of the mesh before it is made: a sheet has fewer elements than nodes.
Tissue restored(const Tissue& initial, const ModelMemory& memory, const TissueChange& change, std::size_t nodes) {
  require(!why_unchangeable(initial));
  require(memory.sheet.cells.size() == change.origin.size() &&
          is_consistent(memory.sheet, memory.rest_positions.size(), initial.is_periodic()));
  Tissue tissue = initial;
  tissue.sheet = memory.sheet;
  tissue.sheet.connect();
  tissue.rest_positions = memory.rest_positions;
  tissue.hanging.clear();
  tissue.next_cell_id = memory.next_cell_id;
  tissue.cells = inherited(change, initial.cells);
  std::size_t elements = 0;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    Cell& cell = tissue.cells[c];
    Cell::parts(cell) = Cell::parts(memory.cells[c]);
    const Polygon& polygon = tissue.sheet.cells[c];
    const std::size_t sides = polygon.sides().size();
    require(cell.rest_shape.size() == 2 * sides);
    require(!cell.is_of_grid || (sides == 4 && polygon.quadrilaterals.size() == 1));
    elements += element_count(tissue.sheet, CellId(c));
    require(elements <= nodes);
  }
  complete(tissue, change);
  require(tissue.node_count() == nodes);
  for (const auto& element : tissue.elements)
    require(std::set<NodeId>(element.begin(), element.end()).size() == element.size());
  return tissue;
}

void restore_growths(const std::vector<Growth>& growths, Model& model) {
  for (const Growth& growth : growths) {
    require(growth.cell.is_among(model.tissue.cells.size()));
    const std::size_t corners = model.tissue.cells[growth.cell.index()].rest_shape.size();
    require(growth.rest_from.size() == corners && growth.rest_to.size() == corners);
  }
  model.growths = growths;
}

}  // namespace

ModelMemory memory_of(const Model& model, std::vector<CellId> origin) {
  const Tissue& tissue = model.tissue;
  ModelMemory memory{.origin = std::move(origin),
                     .sheet = tissue.sheet,
                     .rest_positions = tissue.rest_positions,
                     .cells = std::vector<Cell>(tissue.cells.size()),
                     .next_cell_id = tissue.next_cell_id,
                     .held = model.held,
                     .growths = model.growths,
                     .laws = {}};
  memory.rest_positions.resize(tissue.free_node_count());
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) Cell::parts(memory.cells[c]) = Cell::parts(tissue.cells[c]);
  for (const auto& law : model.laws) memory.laws.push_back(law->past());
  return memory;
}

TissueChange change_of(const ModelMemory& memory, const Tissue& initial) {
  require(memory.origin.size() == memory.cells.size());
  TissueChange change = no_change(initial);
  change.origin = memory.origin;
  std::map<CellId, CellId> first;   // of the cells of one origin
  std::map<int, CellId> of_mother;  // origin of its daughters
  for (std::size_t c = 0; c < memory.origin.size(); ++c) {
    require(memory.origin[c].is_among(initial.cells.size()));
    const Lineage& lineage = memory.cells[c].lineage;
    require(lineage.mother < 0 ? lineage.id == initial.cells[memory.origin[c].index()].lineage.id
                               : of_mother.emplace(lineage.mother, memory.origin[c]).first->second == memory.origin[c]);
    const auto [known, is_new] = first.emplace(memory.origin[c], CellId(c));
    if (!is_new) change.daughters.push_back({known->second, CellId(c)});
  }
  return change;
}

Model restored(const Model& initial, const ModelMemory& memory, std::size_t nodes) try {
  const TissueChange change = change_of(memory, initial.tissue);
  Model model(restored(initial.tissue, memory, change, nodes));
  const Vectors& positions = model.tissue.rest_positions;
  require(memory.held.size() == nodes && memory.laws.size() == initial.laws.size());
  model.held = memory.held;
  restore_growths(memory.growths, model);
  model.volumes = initial.volumes.divided(model.tissue, change);
  model.signals = initial.signals.after(model.tissue, change);
  model.stiffness_scale = initial.stiffness_scale;
  for (std::size_t l = 0; l < initial.laws.size(); ++l) {
    model.laws.push_back(initial.laws[l]->restored(model.tissue, change, positions, memory.laws[l]));
    model.laws.back()->set_label(initial.laws[l]->label());
  }
  for (const auto& constraint : initial.constraints)
    model.constraints.push_back(constraint->after_change(model.tissue, change, positions));
  for (const auto& obstacle : initial.obstacles)
    model.obstacles.push_back(obstacle->after_change(model.tissue, change));
  return model;
} catch (const MeshError&) {  // of a law: cells that share a face wrongly
  throw InvalidNumbers();
}

}  // namespace plica
