#include "tissue/lattice.hpp"

#include <cmath>
#include <utility>

#include "tissue/mesher.hpp"

namespace plica {
namespace {

// The chain of lattice nodes from one corner of the cell to another along an edge.
std::vector<NodeId> edge_chain(const CellLattice& lattice, const std::array<int, 2>& corners) {
  std::array<int, 3> from{}, step{};
  int segments = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const int a = hex_reference_nodes[corners[0]][axis] > 0 ? lattice.elements[axis] : 0;
    const int b = hex_reference_nodes[corners[1]][axis] > 0 ? lattice.elements[axis] : 0;
    from[axis] = a;
    step[axis] = (b > a) - (b < a);
    segments += std::abs(b - a);
  }
  std::vector<NodeId> chain;
  for (int s = 0; s <= segments; ++s)
    chain.push_back(lattice.node(from[0] + s * step[0], from[1] + s * step[1], from[2] + s * step[2]));
  return chain;
}

void set_corners_and_edges(const CellLattice& lattice, const Vectors& rest_positions, Cell& cell) {
  cell.corners.resize(8);
  cell.edges.resize(12);
  for (int i = 0; i < 8; ++i) {
    const Vec3& r = hex_reference_nodes[i];
    cell.corners[i] = lattice.node(r.x() > 0 ? lattice.elements[0] : 0, r.y() > 0 ? lattice.elements[1] : 0,
                                   r.z() > 0 ? lattice.elements[2] : 0);
  }
  // The direction of u and v along the embryo is the one whose mean edge deviates less from x.
  std::array<Vec3, 2> mean = {Vec3::Zero(), Vec3::Zero()};
  for (int e = 0; e < 8; ++e) {
    const auto [a, b] = hex_edges[e];
    mean[e / 4] += rest_positions[cell.corners[b].index()] - rest_positions[cell.corners[a].index()];
  }
  const bool u_is_along = std::abs(mean[0].x()) * mean[1].norm() >= std::abs(mean[1].x()) * mean[0].norm() * (1 - 1e-9);
  for (int e = 0; e < 12; ++e) {
    CellEdge& edge = cell.edges[e];
    edge.nodes = edge_chain(lattice, hex_edges[e]);
    if (e >= 8) {
      edge.direction = EdgeDirection::lateral;
      edge.side = CellSide::lateral;
    } else {
      edge.direction = (e < 4) == u_is_along ? EdgeDirection::along : EdgeDirection::across;
      edge.side = e % 4 < 2 ? CellSide::basal : CellSide::apical;
      edge.along = edge.direction == EdgeDirection::along ? 1 : 0;
    }
  }
}

// The lines of element edges on the apical and basal faces, those of the rim with half a share, and the lateral edges.
void set_lines(const CellLattice& lattice, Cell& cell) {
  cell.lines.clear();
  for (const CellSide side : {CellSide::basal, CellSide::apical}) {
    const int w = side == CellSide::apical ? lattice.elements[2] : 0;
    for (const int axis : {0, 1}) {  // the axis along which the line runs
      const int segments = lattice.elements[axis], lines = lattice.elements[1 - axis];
      for (int across = 0; across <= lines; ++across) {
        CellLine line;
        const CellEdge& like = cell.edges[axis == 0 ? 0 : 4];
        for (int along = 0; along <= segments; ++along)
          line.chain.nodes.push_back(axis == 0 ? lattice.node(along, across, w) : lattice.node(across, along, w));
        line.chain.side = side;
        line.chain.direction = like.direction;
        line.chain.along = like.along;
        line.share = (across == 0 || across == lines ? 1.0 : 2.0) / lines;
        cell.lines.push_back(std::move(line));
      }
    }
  }
  for (int e = 8; e < 12; ++e) cell.lines.push_back({cell.edges[e], 1});
}

// Columns of lattices are nodes above each other.
void add_polygon(const CellLattice& lattice, SheetOfColumns& sheet) {
  const auto [nu, nv, nw] = lattice.elements;
  const auto column = [&](int u, int v) {
    SheetOfColumns::Column nodes;
    for (int w = 0; w <= lattice.elements[2]; ++w) nodes.push_back(lattice.node(u, v, w));
    return nodes;
  };
  const auto add_side = [&](int u, int v, int du, int dv, int parts) {
    std::vector<SheetOfColumns::Column> stops;
    for (int part = 0; part < parts; ++part) stops.push_back(column(u + part * du, v + part * dv));
    sheet.add_side(stops);
  };
  Polygon& polygon = sheet.add_cell(lattice.has_basal, lattice.has_apical);
  add_side(0, 0, 1, 0, nu), add_side(nu, 0, 0, 1, nv), add_side(nu, nv, -1, 0, nu), add_side(0, nv, 0, -1, nv);
  for (int v = 0; v < nv; ++v)
    for (int u = 0; u < nu; ++u)
      polygon.quadrilaterals.push_back({sheet.place(column(u, v)), sheet.place(column(u + 1, v)),
                                        sheet.place(column(u + 1, v + 1)), sheet.place(column(u, v + 1))});
}

}  // namespace

void set_corners_and_lines(const CellLattice& lattice, const Vectors& rest_positions, Cell& cell) {
  set_corners_and_edges(lattice, rest_positions, cell);
  set_lines(lattice, cell);
}

Tissue tissue_from_lattices(const std::vector<CellLattice>& cells, Vectors rest_positions) {
  Tissue tissue;
  tissue.rest_positions = std::move(rest_positions);
  SheetOfColumns sheet;
  for (const CellLattice& lattice : cells) {
    add_polygon(lattice, sheet);
    Cell& cell = tissue.cells.emplace_back();
    cell.grid_place = lattice.grid_place;
    cell.is_of_grid = true;
    cell.lineage.id = tissue.next_cell_id++;
    set_corners_and_lines(lattice, tissue.rest_positions, cell);
    for (const NodeId corner : cell.corners) cell.rest_shape.push_back(tissue.rest_positions[corner.index()]);
  }
  tissue.sheet = sheet.sheet();
  mesh(tissue);
  tissue.regions["all"] = CellSet(tissue.cells.size(), true);
  return tissue;
}

}  // namespace plica
