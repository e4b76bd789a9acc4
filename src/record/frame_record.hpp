// Snapshot of a run, copied from model and state so that it can be written while these change.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "measure/cell_columns.hpp"
#include "measure/furrow.hpp"
#include "mechanics/model.hpp"
#include "record/mesh_writer.hpp"

namespace plica {

/// Part of a snapshot that changes only at divisions.
struct FrameCells {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<CellId> element_cell;
  std::size_t cells = 0, nodes = 0;
  std::vector<std::pair<std::string, std::vector<int>>> regions;   // cells, by array name
  std::vector<std::pair<std::string, std::vector<double>>> given;  // cells: measured data of the scenario
  FramePolygons polygons;

  explicit FrameCells(const Tissue& tissue);
};

struct FrameRecord {
  double time_s = 0;
  std::shared_ptr<const FrameCells> cells;
  Vectors positions;                                                 // nodes
  std::vector<std::pair<std::string, Vectors>> vectors;              // nodes, by array name
  std::vector<std::pair<std::string, std::vector<double>>> scalars;  // cells
  std::vector<std::pair<std::string, std::vector<int>>> integers;    // cells
  std::map<std::string, std::vector<std::vector<double>>> columns;   // with rows of tables, by file name

  [[nodiscard]] MeshElements mesh() const;
  /// Data of the snapshot's file; they refer to this record.
  [[nodiscard]] MeshArrays arrays() const;
};

/// Creates snapshots of a run.
class FrameTaker {
 public:
  /// `sites`: null without a fold. `with_cell_rows`: snapshots include the rows of cells.csv.
  FrameTaker(const Model& model, const FurrowSites* sites, bool with_cell_rows);

  /// `outside`: arrays of cells besides those of the model (Simulation::outside_arrays).
  [[nodiscard]] FrameRecord take(const Model& model, const State& state,
                                 const std::map<std::string, CellArray>& outside) const;

  /// Headers of the tables with rows of each snapshot, by file name.
  [[nodiscard]] std::map<std::string, std::vector<std::string>> tables() const;

  /// Update after a division of the tissue and the sites.
  void follow_division(const Tissue& tissue);

 private:
  void add_cells(const MeasuredCells& measured, FrameRecord& frame) const;
  void add_fold(const MeasuredCells& measured, FrameRecord& frame) const;

  std::vector<std::string> signal_arrays_;  // names, in the order of the model's signals
  const FurrowSites* sites_;
  bool with_cell_rows_;
  std::shared_ptr<const FrameCells> cells_;
  std::vector<SectionCell> section_cells_;
};

}  // namespace plica
