// Tissue: nodes, elements, cells, faces, edges and regions of a sheet of cells in its reference state. A cell is a
// prism over a polygon, made of hexahedra. Topology and reference geometry are constant during a run (only division
// makes a new tissue); present node positions are in State.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/outer_shape.hpp"
#include "tissue/sheet.hpp"

namespace plica {

/// Bilinear facet of the apical or basal surface, counter-clockwise seen from outside the cell.
struct Facet {
  std::array<NodeId, 4> nodes;
  CellId cell;
  ElementId element;
};

/// Direction of a cell edge: along the axis of the embryo (x), across it, or apico-basal.
enum class EdgeDirection { along, across, lateral };

/// Side of the cell on which an edge lies. Lateral edges connect both sides.
enum class CellSide { basal, apical, lateral };

/// Edge of a cell, as a chain of nodes of element edges (two nodes with one element per cell).
struct CellEdge {
  std::vector<NodeId> nodes;
  EdgeDirection direction;  // for polygons, the nearer of along and across
  CellSide side;
  double along = 0;  // alignment with x: squared cosine, 1 or 0 on a grid
};

/// Line along which a cell may contract: one of its edges or, in a grid cell of several elements, a parallel line of
/// element edges across its apical or basal face. `share` is the fraction of an edge tension carried by the line: on a
/// grid, the shares per face and direction sum to 2, those of the two edges of an undivided cell.
struct CellLine {
  CellEdge chain;
  double share = 1;
};

/// Place of a cell on the box whose surface grid the embryo was made from.
struct GridPlace {
  enum class Face { ventral, dorsal, left, right, anterior, posterior };
  Face face;
  std::array<int, 2> place;  // column along, row across (anterior and posterior: across, then ventral to dorsal)
  std::array<int, 2> count;  // columns and rows of that face
};

/// Lineage of a cell. Ids are unique and never reused, independent of the position in `Tissue::cells`.
struct Lineage {
  int id = -1;
  int mother = -1;  // -1: initial cell
  int generation = 0;
  double birth_s = 0;

  static auto parts(auto& lineage) { return std::tie(lineage.id, lineage.mother, lineage.generation, lineage.birth_s); }
};

struct Cell {
  ElementId first_element;
  int element_count = 1;                // its elements are contiguous
  bool is_of_grid = false;              // four walls, whose edges run along and across
  std::vector<NodeId> corners;          // both polygons: basal, then the apical ones above (see below)
  std::vector<CellEdge> edges;          // grid cells: in the order of hex_edges; else basal, apical, lateral
  std::vector<CellLine> lines;          // contractile lines: the edges, except in grid cells of several elements
  std::optional<GridPlace> grid_place;  // built embryos only
  std::vector<Vec3> rest_shape;         // um; corners
  std::optional<double> target_volume;  // um^3; that of the rest shape, except after a division
  Lineage lineage;

  // Corners of both polygons are counter-clockwise seen from outside the tissue, above the apical surface. Four corners
  // are in VTK order of a hexahedron.
  [[nodiscard]] std::size_t sides() const { return corners.size() / 2; }
  [[nodiscard]] std::span<const NodeId> basal_corners() const { return std::span(corners).first(sides()); }
  [[nodiscard]] std::span<const NodeId> apical_corners() const { return std::span(corners).last(sides()); }

  /// Members that do not follow from the sheet.
  static auto parts(auto& cell) { return std::tie(cell.rest_shape, cell.target_volume, cell.lineage); }
};

/// Values by cell, which follow changes of the tissue (tissue_change.hpp).
template <class Value>
struct ByCell : std::vector<Value> {
  using std::vector<Value>::vector;
  ByCell() = default;
  ByCell(std::vector<Value> values) : std::vector<Value>(std::move(values)) {}  // NOLINT: meant to convert
};

/// Cell set: one flag per cell.
using CellSet = ByCell<bool>;

using CellArray = ByCell<double>;

/// Position of a hanging node: weighted mean of free nodes; weights sum to 1.
using NodeMean = std::vector<std::pair<NodeId, double>>;

inline Vec3 mean_of(const NodeMean& mean, std::span<const Vec3> vectors) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [node, weight] : mean) sum += weight * vectors[node.index()];
  return sum;
}

struct Tissue {
  Sheet sheet;  // topology of cells; from it and the rest positions of free nodes follow elements, facets and lines
  // Nodes: first free ones, then hanging ones. A free node keeps its number until a cell leaves.
  Vectors rest_positions;         // nodes; um
  std::vector<NodeMean> hanging;  // last nodes; with polygons or after divisions
  // Offset of each hanging node from its mean, um. Empty unless periodic: there, a node at the far end of a period is
  // an image, which hangs on one node only.
  Vectors hanging_shifts;
  Vec3 period = Vec3::Zero();                   // lengths along x, y, z, um; 0 if not periodic
  std::vector<std::array<NodeId, 8>> elements;  // VTK order
  std::vector<CellId> element_cell;             // elements
  std::vector<HexPoints> element_rest_shape;    // elements; um. Daughters inherit it, independent of node positions
  std::vector<Cell> cells;
  std::vector<Facet> apical_facets;  // element facets; contiguous per cell
  std::vector<Facet> basal_facets;
  std::optional<OuterShape> outer_shape;         // reference apical surface, or the shell around a mesh from a file
  std::map<std::string, CellArray> cell_arrays;  // from a file: measured values per cell
  std::map<std::string, CellSet> regions;        // by name; "all" always exists
  std::vector<std::string> remarks;              // repairs made while building
  int next_cell_id = 0;                          // for Lineage
  // Axes across whose planes through the origin this is one side of a symmetric tissue (mirror.hpp). Nodes on a plane
  // have coordinate 0 there.
  std::array<bool, 3> is_mirrored = {false, false, false};
  bool is_endless = false;  // along x: a slice, whose ends are shared with adjacent slices

  static auto parts_by_cell(auto& tissue) { return std::tie(tissue.cell_arrays, tissue.regions); }

  /// Return the fraction of an object spanned by these nodes that belongs to this side: 1/2 per mirror plane that
  /// contains all of them.
  [[nodiscard]] double side_share(std::span<const NodeId> nodes) const;

  /// Return the facets of the apical or basal surface.
  [[nodiscard]] const std::vector<Facet>& facets(CellSide side) const {
    return side == CellSide::apical ? apical_facets : basal_facets;
  }

  [[nodiscard]] std::size_t node_count() const { return rest_positions.size(); }
  [[nodiscard]] std::size_t free_node_count() const { return rest_positions.size() - hanging.size(); }

  /// Call `take(free node, weight)` for the node itself if it is free, else for each node that it hangs on.
  template <class Take>
  void for_free_nodes(NodeId node, Take take) const {
    if (node.index() < free_node_count()) return take(node, 1.0);
    for (const auto& [free, weight] : hanging[node.index() - free_node_count()]) take(free, weight);
  }

  [[nodiscard]] bool is_periodic() const { return !hanging_shifts.empty(); }

  /// Return the free node of which a node is the image; any other node itself.
  [[nodiscard]] NodeId original(NodeId node) const {
    if (node.index() < free_node_count()) return node;
    const NodeMean& mean = hanging[node.index() - free_node_count()];
    return mean.size() == 1 ? mean.front().first : node;
  }

  /// Set hanging nodes from their free nodes, for vectors linear in positions (directions, velocities); one Vec3 per
  /// node.
  void place_hanging(std::span<Vec3> vectors) const;
  /// Set positions of hanging nodes from their free nodes; images are a period away.
  void place_hanging_positions(std::span<Vec3> positions) const;

  /// Move forces on hanging nodes to the free nodes that carry them.
  void carry_hanging(std::span<Vec3> forces) const;
};

/// Return the points of an element or a face among `positions`.
template <std::size_t count>
std::array<Vec3, count> gather(std::span<const Vec3> positions, const std::array<NodeId, count>& nodes) {
  std::array<Vec3, count> points;
  for (std::size_t i = 0; i < count; ++i) points[i] = positions[nodes[i].index()];
  return points;
}
inline std::array<Vec3, 4> gather(std::span<const Vec3> positions, const Facet& facet) {
  return gather(positions, facet.nodes);
}

/// Interval of numbers; empty until it has taken one.
struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  void take(double value) { low = std::min(low, value), high = std::max(high, value); }
};

/// Return the extent of the tissue along x in the reference state, um.
Extent extent_along(const Tissue& tissue);

/// Return the corners of a grid cell, or its rest shape, as a hexahedron.
HexPoints hexahedron(std::span<const Vec3> corners);

/// Return the mean of the corners of the cell: its monitored barycentre.
Vec3 cell_centre(const Cell& cell, const Vectors& positions);

/// Return the corners of the facet in the rest shape of its element, which changes only when daughters grow.
std::array<Vec3, 4> rest_corners(const Tissue& tissue, const Facet& facet);

/// Return the apical or basal area of each cell, um^2, at these positions or of the rest shapes; 0 for a cell without.
/// Bilinear facets, 2 x 2 Gauss points.
std::vector<double> face_areas(const Tissue& tissue, CellSide side, std::span<const Vec3> positions);
std::vector<double> rest_face_areas(const Tissue& tissue, CellSide side);

/// Return the volume of a cell, um^3: the sum over its elements.
double cell_volume(const Tissue& tissue, const Cell& cell, std::span<const Vec3> positions);
/// Return that of the rest shapes of its elements.
double rest_volume(const Tissue& tissue, const Cell& cell);

}  // namespace plica
