// What is measured of single cells and nodes at a moment: one table each for the cells of cells.csv and of frames, the
// nodes of frames, midline.csv and lineage.csv. Headers, rows, arrays and the tables in docs/reference/measures.md come
// from them.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "measure/cross_section.hpp"
#include "measure/furrow.hpp"
#include "mechanics/model.hpp"

namespace plica {

/// What the values of cells are made from. What several of them need is made once.
struct MeasuredCells {
  MeasuredCells(const Model& of_model, const State& at_state);

  const Model& model;
  const State& state;
  std::vector<double> apical_areas, rest_apical_areas;  // cells

  /// Of every cell its apical area over that at rest; NaN where it has no apical face.
  [[nodiscard]] std::vector<double> apical_area_ratios() const;
};

/// What a frame has of a column.
enum class InFrames { nothing, numbers, integers };

/// A value of each cell. NaN: it has none.
struct CellColumn {
  std::string_view name;  // with its unit
  bool in_csv;            // cells.csv
  InFrames in_frames;
  std::string_view meaning;  // for docs/reference/measures.md, in Markdown
  std::function<std::vector<double>(const MeasuredCells&)> values;
  std::optional<double> none_in_frames = {};  // what stands for none in a frame, which holds numbers only
};

/// In the order of cells.csv; those that it has.
std::span<const CellColumn> cell_columns();
std::vector<std::string> cells_csv_names();

/// Whether cell data of frames have this name: of these columns, or a region's. What a file has measured in its cells
/// stands beside them under its own names; of these, it is left out.
bool is_plicas(std::string_view cell_array);

/// A column that goes to one place only.
template <class Values>
struct PlainColumn {
  std::string_view name;
  std::string_view meaning;
  std::function<Values> values;
};

/// A vector of each node, in frames.
using NodeColumn = PlainColumn<Vectors(const Model&, const State&)>;
std::span<const NodeColumn> node_columns();

/// A value of each cell of the midline (FurrowSites::midline), in the order of midline.csv. NaN: it has none.
using MidlineColumn = PlainColumn<std::vector<double>(const MeasuredCells&, const FurrowSites&)>;
std::span<const MidlineColumn> midline_columns();

/// What the values of cells in cross-sections are made from.
struct MeasuredSections {
  const MeasuredCells& measured;
  std::span<const SectionCell> cells;
  std::span<const FaceShape> apices;  // theirs
};

/// A value of each of these cells, in the order of cross_section.csv. NaN: it has none.
using SectionColumn = PlainColumn<std::vector<double>(const MeasuredSections&)>;
std::span<const SectionColumn> section_columns();

/// A value of a daughter when she is born, in lineage.csv.
using LineageColumn = PlainColumn<double(const Lineage&)>;
std::span<const LineageColumn> lineage_columns();

}  // namespace plica
