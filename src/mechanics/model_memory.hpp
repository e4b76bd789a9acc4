// Changes of a model by divisions, for checkpoints: the data that do not follow from the model of the scenario. Mesh,
// laws and constraints are rebuilt from them. Rejected: repeating the divisions, which takes the positions at each, and
// saving all of the tissue, most of which is its mesh.
#pragma once

#include <array>
#include <tuple>
#include <vector>

#include "mechanics/model.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {

/// Data of a model whose cells have divided.
struct ModelMemory {
  std::vector<CellId> origin;  // cells; the cell of the initial tissue that each descends from
  Sheet sheet;
  Vectors rest_positions;                 // free nodes; um
  std::vector<Cell> cells;                // only Cell::parts
  int next_cell_id = 0;                   // of the tissue
  std::vector<std::array<bool, 3>> held;  // nodes
  std::vector<Growth> growths;
  std::vector<std::vector<double>> laws;  // Law::past

  static auto parts(auto& memory) {
    return std::tie(memory.origin, memory.sheet, memory.rest_positions, memory.cells, memory.next_cell_id, memory.held,
                    memory.growths, memory.laws);
  }
};

/// Return the data of a model, as it is after its last division.
ModelMemory memory_of(const Model& model, std::vector<CellId> origin);

/// Return all divisions of the initial tissue as one, without its nodes, for data by cell. Throws InvalidNumbers unless
/// the cells descend from such a tissue.
TissueChange change_of(const ModelMemory& memory, const Tissue& initial);

/// Return the model with this memory; `nodes`: expected number of nodes of its tissue. Throws std::logic_error unless
/// they fit the initial model.
Model restored(const Model& initial, const ModelMemory& memory, std::size_t nodes);

}  // namespace plica
