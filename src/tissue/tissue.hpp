// What exists: nodes, elements, cells, faces, edges and regions of one layer of hexahedral cells, at rest. Topology and
// rest geometry never change during a run (only division makes a new tissue); where the nodes are now is the State's.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "tissue/hexahedron.hpp"

namespace plica {

/// A bilinear facet of the apical or basal surface, counter-clockwise seen from outside the cell.
struct Facet {
  std::array<NodeId, 4> nodes;
  CellId cell;
};

/// The direction of a cell's edge: along the embryo's axis (x), across it, or apico-basal.
enum class EdgeDirection { along, across, lateral };

/// The side of the cell on which an edge lies. Lateral edges run from one to the other.
enum class EdgeSide { basal, apical, lateral };

/// One of a cell's twelve edges, as the chain of nodes of its elements' edges (two nodes with one element a cell).
struct CellEdge {
  std::vector<NodeId> nodes;
  EdgeDirection direction;
  EdgeSide side;
};

/// A line along which a cell may contract: one of its edges or, in a cell of several elements, a line of element edges
/// across its apical or basal face that runs beside them. `share` is the part of an edge's tension that the line
/// carries: per face and direction the shares add up to 2, those of the two edges of an undivided cell.
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

struct Cell {
  ElementId first_element;
  int element_count = 1;                // its elements are contiguous
  std::array<NodeId, 8> corners;        // VTK's order: 0-3 basal, 4-7 apical
  std::array<CellEdge, 12> edges;       // in the order of hex_edges
  std::vector<CellLine> lines;          // what can contract; the edges themselves in a cell of one element
  std::optional<GridPlace> grid_place;  // of a built embryo
};

/// A capsule (a cylinder between two half balls, axis on x), or a ball when half_axis is 0: the shape of built embryos.
struct Capsule {
  double half_axis_um = 0;  // half the length of the cylinder
  double radius_um = 0;
};

/// A set of cells: one flag a cell.
using CellSet = std::vector<bool>;

struct Tissue {
  Vectors rest_positions;                       // nodes; um
  std::vector<std::array<NodeId, 8>> elements;  // VTK's order
  std::vector<CellId> element_cell;             // elements
  std::vector<HexPoints> element_rest_shape;    // elements; um. A daughter's is her mother's, not where her nodes are
  std::vector<Cell> cells;
  std::vector<Facet> apical_facets;  // of elements; those of a cell are contiguous
  std::vector<Facet> basal_facets;
  std::optional<Capsule> outer_shape;          // of the apical surface at rest, or the shell around a file's mesh
  std::map<std::string, CellSet> cell_arrays;  // of a mesh file: cells where the array is not 0
  std::map<std::string, CellSet> regions;      // named; "all" is always there

  [[nodiscard]] std::size_t node_count() const { return rest_positions.size(); }
};

/// The element's points among `positions`.
inline HexPoints gather(const std::vector<Vec3>& positions, const std::array<NodeId, 8>& nodes) {
  HexPoints points;
  for (int i = 0; i < 8; ++i) points[i] = positions[nodes[i].index()];
  return points;
}

/// Mean of the cell's eight corners: its barycentre as monitored.
Vec3 cell_centre(const Cell& cell, const Vectors& positions);

/// Volume of a cell: the sum over its elements, um^3.
double cell_volume(const Tissue& tissue, const Cell& cell, const Vectors& positions);

}  // namespace plica
