// Sheet: topology of a layer of cells, without geometry. Its vertices are columns of nodes, its walls join two of them,
// its cells are rings of walls. Changes of topology are operations on it (docs/decisions/0014-one-sheet.md); the mesh
// follows from it (mesher.hpp).
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ids.hpp"

namespace plica {

using VertexId = Id<struct VertexTag>;
using WallId = Id<struct WallTag>;

/// Nodes one above the other, from base to apex.
struct Vertex {
  std::vector<NodeId> nodes;               // none: no cell uses the vertex
  VertexId original = {};                  // of an image at the end of a period; invalid: it is no image
  std::array<int, 3> periods = {0, 0, 0};  // from there, along x, y, z

  static auto parts(auto& vertex) { return std::tie(vertex.nodes, vertex.original, vertex.periods); }
};

/// Lateral face between two adjacent vertices: part of a side of two cells, or of one at a rim.
struct Wall {
  std::array<CellId, 2> cells;  // left and right of it; invalid: none

  [[nodiscard]] CellId beyond(CellId cell) const { return cells[cells[0] == cell ? 1 : 0]; }
};

/// Round a place on a side to a multiple of 2^-32, so that it is the same from either end.
double rounded_place(double at);

/// Vertex on the outline of a polygon: a corner, or a stop on a side, where the neighbour has a corner or a line ends.
struct Stop {
  VertexId vertex;
  WallId wall;    // from here to the next stop
  double at = 0;  // on its side, from its first corner (0) to the next (1)

  static auto parts(auto& stop) { return std::tie(stop.vertex, stop.at); }
};

/// Place in a polygon: on a side of its outline; a vertex within; or the mean of the corners.
struct OutlinePlace {
  int wall = -1;  // side; -1: within
  double at = 0;
  int inner = -1;  // of Polygon::inner

  [[nodiscard]] bool is_middle() const { return wall < 0; }
  bool operator==(const OutlinePlace&) const = default;
  static auto parts(auto& place) { return std::tie(place.wall, place.at, place.inner); }
};

/// Quadrilateral of a split polygon: its corners, counter-clockwise seen from outside.
using OutlineQuad = std::array<OutlinePlace, 4>;

/// Side of a polygon: its first corner and the stops after it.
using Side = std::vector<Stop>;

/// Cell as a polygon, counter-clockwise seen from outside.
struct Polygon {
  std::vector<Stop> ring;  // from corner 0
  std::vector<VertexId> inner;
  std::vector<OutlineQuad> quadrilaterals;   // its split; none: it has another mesh, and cannot change
  bool has_basal = true, has_apical = true;  // faces on the surface of the tissue

  [[nodiscard]] const Stop& after(std::size_t stop) const { return ring[(stop + 1) % ring.size()]; }
  /// Place of the stop after a stop, on the side of the latter.
  [[nodiscard]] double end_of(std::size_t stop) const { return after(stop).at == 0 ? 1 : after(stop).at; }
  [[nodiscard]] std::vector<Side> sides() const;
  /// Set the ring from sides.
  void take_sides(const std::vector<Side>& sides);

  static auto parts(auto& polygon) {
    return std::tie(polygon.ring, polygon.inner, polygon.quadrilaterals, polygon.has_basal, polygon.has_apical);
  }
};

struct Sheet {
  std::vector<Vertex> vertices;
  std::vector<Wall> walls;
  std::vector<Polygon> cells;

  /// Return the vertex of which one is an image; any other itself.
  [[nodiscard]] VertexId original_of(VertexId vertex) const {
    const VertexId its = vertices[vertex.index()].original;
    return its.valid() ? its : vertex;
  }
  /// Return the number of elements of a cell from base to apex.
  [[nodiscard]] std::size_t level_count(CellId cell) const {
    return vertices[cells[cell.index()].ring.front().vertex.index()].nodes.size() - 1;
  }

  /// Make the walls of all rings. MeshError if more than two cells share one, or two on the same side.
  void connect();
  /// Add a wall to the right of which, and to the left, these cells are.
  WallId add_wall(CellId left, CellId right = {});

  /// Insert a vertex into a wall, for both of its cells; return the part beyond the vertex, in the direction of the
  /// left cell.
  WallId split_wall(WallId wall, VertexId vertex);

  /// Keep only these cells, in this order. Columns and walls keep their numbers.
  void keep(std::span<const CellId> kept);

  /// Members from which walls follow (connect).
  static auto parts(auto& sheet) { return std::tie(sheet.vertices, sheet.cells); }
};

/// Makes a sheet, cell by cell, from columns: nodes from base to apex.
class SheetOfColumns {
 public:
  using Column = std::vector<NodeId>;

  /// Begin a cell.
  Polygon& add_cell(bool has_basal = true, bool has_apical = true);
  /// Add its next side: a corner and the stops after it, evenly spaced.
  void add_side(const std::vector<Column>& stops);
  /// Return the place of a column: on a side of the cell, or else within, where it becomes a vertex.
  OutlinePlace place(const Column& column);
  /// Return the sheet, with its walls.
  Sheet sheet();

 private:
  VertexId vertex_of(const Column& column);

  Sheet sheet_;
  int sides_ = 0;                                           // of the present cell
  std::map<VertexId, OutlinePlace> places_;                 // in it
  std::map<std::pair<NodeId, NodeId>, VertexId> vertices_;  // by base and apex
};

/// Whether the vertices and splits of polygons fit this number of free nodes, for a sheet from outside.
bool is_consistent(const Sheet& sheet, std::size_t free_nodes, bool has_images);

}  // namespace plica
