// Output variables of cells and nodes, one table per file: cells.csv and snapshots, nodes of snapshots, midline.csv,
// cross_section.csv and lineage.csv. Headers, rows, arrays and the tables of docs/reference/measures.md follow from
// them.
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

/// Data shared by the variables of cells, computed once.
struct MeasuredCells {
  MeasuredCells(const Model& of_model, const State& at_state);

  const Model& model;
  const State& state;
  std::vector<double> apical_areas, rest_apical_areas;  // cells

  /// Apical area / reference area; cells. NaN without an apical face.
  [[nodiscard]] std::vector<double> apical_area_ratios() const;
};

/// Type of a column in snapshots.
enum class InFrames { nothing, numbers, integers };

/// Variable with one value per cell; NaN if missing.
struct CellColumn {
  std::string_view name;  // with its unit
  bool in_csv;            // cells.csv
  InFrames in_frames;
  std::string_view meaning;  // for docs/reference/measures.md, in Markdown
  std::function<std::vector<double>(const MeasuredCells&)> values;
  std::optional<double> none_in_frames = {};  // replacement of missing values in snapshots
};

/// All variables of cells, and the names of those in cells.csv, in its order.
std::span<const CellColumn> cell_columns();
std::vector<std::string> cells_csv_names();

/// Name of a signal in cells.csv and snapshots.
inline std::string array_of_signal(const std::string& signal) { return "signal_" + signal; }

/// Whether plica writes cell data of this name to snapshots (a column, a region or a signal). Measured data of an input
/// file with such a name are not copied to snapshots.
bool is_plicas(std::string_view cell_array);

/// Variable of a single file.
template <class Values>
struct PlainColumn {
  std::string_view name;
  std::string_view meaning;
  std::function<Values> values;
};

/// Variable with one vector per node, in snapshots.
using NodeColumn = PlainColumn<Vectors(const Model&, const State&)>;
std::span<const NodeColumn> node_columns();

/// Variable with one value per midline cell (FurrowSites::midline), in the order of midline.csv; NaN if missing.
using MidlineColumn = PlainColumn<std::vector<double>(const MeasuredCells&, const FurrowSites&)>;
std::span<const MidlineColumn> midline_columns();

/// Data shared by the variables of cells in cross-sections.
struct MeasuredSections {
  const MeasuredCells& measured;
  std::span<const SectionCell> cells;
  std::span<const FaceShape> apices;  // of these cells
};

/// Variable with one value per cell of the sections, in the order of cross_section.csv; NaN if missing.
using SectionColumn = PlainColumn<std::vector<double>(const MeasuredSections&)>;
std::span<const SectionColumn> section_columns();

/// Variable of a daughter cell at birth, in lineage.csv.
using LineageColumn = PlainColumn<double(const Lineage&)>;
std::span<const LineageColumn> lineage_columns();

}  // namespace plica
