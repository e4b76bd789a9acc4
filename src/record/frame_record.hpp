// One moment of a run as its files will hold it: taken from model and state, so that it can be written while both go
// on.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "measure/furrow.hpp"
#include "mechanics/model.hpp"
#include "record/mesh_writer.hpp"

namespace plica {

/// What only a division changes.
struct FrameCells {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<CellId> element_cell;
  std::size_t cells = 0, nodes = 0;
  std::vector<std::pair<std::string, std::vector<int>>> integers;  // cells: lineage and regions, by their arrays' names

  explicit FrameCells(const Tissue& tissue);
};

struct FrameRecord {
  double time_s = 0;
  std::shared_ptr<const FrameCells> cells;
  Vectors positions, displacements, velocities, forces;              // nodes
  std::vector<std::pair<std::string, std::vector<double>>> scalars;  // cells, by their arrays' names
  std::vector<double> cell_rows;                                     // of cells.csv, row after row; or none
  std::vector<double> midline_rows;                                  // of midline.csv

  [[nodiscard]] MeshElements mesh() const;
  /// Data of the frame's file. They refer to the record.
  [[nodiscard]] MeshArrays arrays() const;
};

inline constexpr const char* cells_header =
    "time_s,cell_id,mother_id,generation,x_um,y_um,z_um,volume_um3,apical_area_um2,basal_area_um2,height_um,"
    "apical_area_ratio,speed_um_per_s,pressure_Pa,activity";
inline constexpr std::size_t cells_columns = 15;
inline constexpr const char* midline_header = "time_s,ap_um,depth_um,normal_speed_um_per_s,apical_area_ratio";
inline constexpr std::size_t midline_columns = 5;

/// Takes records of one model.
class FrameTaker {
 public:
  /// `with_cell_rows`: the records hold those of cells.csv.
  FrameTaker(const Model& model, const FurrowSites& sites, bool with_cell_rows);

  [[nodiscard]] FrameRecord take(const State& state) const;

  [[nodiscard]] bool with_cell_rows() const { return with_cell_rows_; }

  /// The model's cells have divided, and the sites have followed.
  void follow_division();

 private:
  void add_cell_rows(const State& state, const std::vector<double>& apical_areas, const std::vector<double>& rest_areas,
                     FrameRecord& frame) const;
  void add_midline_rows(const State& state, const std::vector<double>& apical_areas,
                        const std::vector<double>& rest_areas, FrameRecord& frame) const;

  const Model& model_;
  const FurrowSites& sites_;
  bool with_cell_rows_;
  std::shared_ptr<const FrameCells> cells_;
  std::vector<Vec3> midline_normals_;  // of the sites' midline: apical, outward, at rest
};

}  // namespace plica
