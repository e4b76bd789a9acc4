// What exists: nodes, elements, cells, faces, edges and regions of one layer of cells, at rest. A cell is a prism over
// a polygon, made of hexahedra. Topology and rest geometry never change during a run (only division makes a new
// tissue); where the nodes are now is the State's.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "tissue/hexahedron.hpp"
#include "tissue/outer_shape.hpp"

namespace plica {

/// A bilinear facet of the apical or basal surface, counter-clockwise seen from outside the cell.
struct Facet {
  std::array<NodeId, 4> nodes;
  CellId cell;
  ElementId element;
};

/// The direction of a cell's edge: along the embryo's axis (x), across it, or apico-basal.
enum class EdgeDirection { along, across, lateral };

/// The side of the cell on which an edge lies. Lateral edges run from one to the other.
enum class CellSide { basal, apical, lateral };

/// One of a cell's edges, as the chain of nodes of its elements' edges (two nodes with one element a cell).
struct CellEdge {
  std::vector<NodeId> nodes;
  EdgeDirection direction;  // of a polygon's edges, the nearer of along and across
  CellSide side;
  double along = 0;  // how far it runs along: the squared cosine, 1 or 0 on a grid
};

/// A line along which a cell may contract: one of its edges or, in a grid's cell of several elements, a line of element
/// edges across its apical or basal face that runs beside them. `share` is the part of an edge's tension that the line
/// carries: on a grid, per face and direction the shares add up to 2, those of the two edges of an undivided cell.
struct CellLine {
  CellEdge chain;
  double share = 1;
};

/// Where a cell lies on the box whose surface grid the embryo was made from.
struct GridPlace {
  enum class Face { ventral, dorsal, left, right, anterior, posterior };
  Face face;
  std::array<int, 2> place;  // column along, row across (anterior and posterior: across, then belly to back)
  std::array<int, 2> count;  // columns and rows of that face
};

/// A place on the lateral wall of a cell where nodes lie, one basal and one apical: a corner of the cell, or where the
/// neighbour behind the wall has been cut.
struct WallStop {
  double at;  // along the wall, from 0 to 1
  NodeId basal, apical;

  bool operator==(const WallStop&) const = default;
};

/// A place on the outline of a cell's polygon: on a wall, from its first corner (0) to the next (1); or not on it, in
/// the middle of the corners.
struct OutlinePlace {
  int wall = -1;  // -1: the middle
  double at = 0;

  [[nodiscard]] bool is_middle() const { return wall < 0; }
  bool operator==(const OutlinePlace&) const = default;
};

/// A quadrilateral that a polygon is split into: its corners, counter-clockwise seen from outside.
using OutlineQuad = std::array<OutlinePlace, 4>;

/// Where a cell comes from. Ids are given once and never again, whatever a cell's place in `Tissue::cells`.
struct Lineage {
  int id = -1;
  int mother = -1;  // -1: was there at the beginning
  int generation = 0;
  double birth_s = 0;
};

struct Cell {
  ElementId first_element;
  int element_count = 1;        // its elements are contiguous
  bool is_of_grid = false;      // four walls, whose edges run along and across
  std::vector<NodeId> corners;  // of its polygons: the basal one's, then the apical one's above them (see below)
  std::vector<CellEdge> edges;  // of a grid, in the order of hex_edges; else basal, apical, lateral
  std::vector<CellLine> lines;  // what can contract; the edges themselves but in grid cells of several elements
  std::optional<GridPlace> grid_place;  // of a built embryo
  // What division needs (division.hpp): the walls, each a chain of stops from a corner to the next, and what the
  // polygon is split into. Empty in a cell that begins with lines of its own: several elements of a grid, kites,
  // layers.
  std::vector<std::vector<WallStop>> walls;
  std::vector<OutlineQuad> quadrilaterals;
  std::vector<Vec3> rest_shape;  // um; corners
  Lineage lineage;

  // Corners of both polygons go counter-clockwise seen from outside the tissue, above the apex. Of four, they are in
  // VTK's order of a hexahedron.
  [[nodiscard]] std::size_t sides() const { return corners.size() / 2; }
  [[nodiscard]] std::span<const NodeId> basal_corners() const { return std::span(corners).first(sides()); }
  [[nodiscard]] std::span<const NodeId> apical_corners() const { return std::span(corners).last(sides()); }
};

/// A set of cells: one flag a cell.
using CellSet = std::vector<bool>;

/// A number a cell.
using CellArray = std::vector<double>;

/// A node without freedom of its own: where it is, is a weighted mean of free nodes. Weights add up to 1.
using NodeMean = std::vector<std::pair<NodeId, double>>;

inline Vec3 mean_of(const NodeMean& mean, std::span<const Vec3> vectors) {
  Vec3 sum = Vec3::Zero();
  for (const auto& [node, weight] : mean) sum += weight * vectors[node.index()];
  return sum;
}

struct Tissue {
  // Nodes: the free ones first, then those that hang on them. A free node keeps its number for good.
  Vectors rest_positions;         // nodes; um
  std::vector<NodeMean> hanging;  // of the last nodes; where cells are polygons or have divided
  // Of these, how far each is from that mean, um. Empty but in a tissue that repeats itself: there, a node at the far
  // end of a period hangs on one node alone, of which it is the image.
  Vectors hanging_shifts;
  std::vector<std::array<NodeId, 8>> elements;  // VTK's order
  std::vector<CellId> element_cell;             // elements
  std::vector<HexPoints> element_rest_shape;    // elements; um. A daughter's is her mother's, not where her nodes are
  std::vector<Cell> cells;
  std::vector<Facet> apical_facets;  // of elements; those of a cell are contiguous
  std::vector<Facet> basal_facets;
  std::optional<OuterShape> outer_shape;         // of the apical surface at rest, or the shell around a file's mesh
  std::map<std::string, CellArray> cell_arrays;  // of a file: what was measured in each cell
  std::map<std::string, CellSet> regions;        // named; "all" is always there
  std::vector<std::string> remarks;              // what had to be mended to build it
  int next_cell_id = 0;                          // for Lineage
  // Axes across whose planes through the origin this is one side of a symmetric tissue (mirror.hpp). Nodes on a plane
  // are at 0 there.
  std::array<bool, 3> is_mirrored = {false, false, false};
  bool is_endless = false;  // along x: a slice, whose ends belong to the next slices, too

  /// How much of what these nodes span is this side's own: a half for each mirror plane in which all of them lie.
  [[nodiscard]] double own_share(std::span<const NodeId> nodes) const;

  [[nodiscard]] std::size_t node_count() const { return rest_positions.size(); }
  [[nodiscard]] std::size_t free_node_count() const { return rest_positions.size() - hanging.size(); }

  /// Calls `take(free node, weight)` for the node itself when it is free, else for each node that it hangs on.
  template <class Take>
  void for_free_nodes(NodeId node, Take take) const {
    if (node.index() < free_node_count()) return take(node, 1.0);
    for (const auto& [free, weight] : hanging[node.index() - free_node_count()]) take(free, weight);
  }

  /// Whether it goes on at an end with what is at the other.
  [[nodiscard]] bool is_periodic() const { return !hanging_shifts.empty(); }

  /// The free node of which a node is the image; any other is its own.
  [[nodiscard]] NodeId original(NodeId node) const {
    if (node.index() < free_node_count()) return node;
    const NodeMean& mean = hanging[node.index() - free_node_count()];
    return mean.size() == 1 ? mean.front().first : node;
  }

  /// Puts hanging nodes where their free nodes say; a Vec3 a node: directions, velocities, or anything linear in them.
  void place_hanging(std::span<Vec3> vectors) const;
  /// The same of positions: images are a period away.
  void place_hanging_positions(std::span<Vec3> positions) const;

  /// Moves forces on hanging nodes to the free nodes that carry them.
  void carry_hanging(std::span<Vec3> forces) const;
};

/// The element's points among `positions`.
inline HexPoints gather(std::span<const Vec3> positions, const std::array<NodeId, 8>& nodes) {
  HexPoints points;
  for (int i = 0; i < 8; ++i) points[i] = positions[nodes[i].index()];
  return points;
}

/// Where a grid cell's corners are, or its rest shape, as those of a hexahedron.
HexPoints hexahedron(std::span<const Vec3> corners);

/// Mean of the cell's corners: its barycentre as monitored.
Vec3 cell_centre(const Cell& cell, const Vectors& positions);

/// The corners of a facet.
inline std::array<Vec3, 4> gather(std::span<const Vec3> positions, const Facet& facet) {
  return {positions[facet.nodes[0].index()], positions[facet.nodes[1].index()], positions[facet.nodes[2].index()],
          positions[facet.nodes[3].index()]};
}

/// The facet's corners in its element's rest shape: where they began, until a daughter grows.
std::array<Vec3, 4> rest_corners(const Tissue& tissue, const Facet& facet);

/// Area of each cell's apical facets, um^2; 0 for a cell without. Bilinear facets, 2 x 2 Gauss points.
std::vector<double> apical_areas(const Tissue& tissue, std::span<const Vec3> positions);
std::vector<double> basal_areas(const Tissue& tissue, std::span<const Vec3> positions);

/// The same at rest, by the cells' rest shapes.
std::vector<double> rest_apical_areas(const Tissue& tissue);

/// Volume of a cell: the sum over its elements, um^3.
double cell_volume(const Tissue& tissue, const Cell& cell, std::span<const Vec3> positions);

}  // namespace plica
