#include "tissue/lattice.hpp"

#include <cmath>
#include <cstdint>
#include <map>
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

// A place on a side as a multiple of 2^-32, so that places from either end are the same.
double place(int part, int parts) {
  constexpr double unit = 1.0 / (std::int64_t{1} << 32);
  return unit * std::round(static_cast<double>(part) / parts / unit);
}

// Makes the polygons of lattices, whose vertices are nodes above each other.
class SheetOfLattices {
 public:
  void add(const CellLattice& lattice) {
    const auto [nu, nv, nw] = lattice.elements;
    Polygon& polygon = sheet_.cells.emplace_back();
    polygon.has_basal = lattice.has_basal;
    polygon.has_apical = lattice.has_apical;
    std::map<std::pair<int, int>, OutlinePlace> places;
    const auto add_side = [&](int side, int u, int v, int du, int dv, int parts) {
      for (int part = 0; part < parts; ++part, u += du, v += dv) {
        polygon.ring.push_back({vertex_of(lattice, u, v), {}, place(part, parts)});
        places[{u, v}] = {side, polygon.ring.back().at};
      }
    };
    add_side(0, 0, 0, 1, 0, nu), add_side(1, nu, 0, 0, 1, nv), add_side(2, nu, nv, -1, 0, nu);
    add_side(3, 0, nv, 0, -1, nv);
    for (int v = 1; v < nv; ++v)
      for (int u = 1; u < nu; ++u) {
        places[{u, v}] = {-1, 0, static_cast<int>(polygon.inner.size())};
        polygon.inner.push_back(vertex_of(lattice, u, v));
      }
    for (int v = 0; v < nv; ++v)
      for (int u = 0; u < nu; ++u)
        polygon.quadrilaterals.push_back(
            {places.at({u, v}), places.at({u + 1, v}), places.at({u + 1, v + 1}), places.at({u, v + 1})});
  }

  Sheet sheet() {
    sheet_.connect();
    return std::move(sheet_);
  }

 private:
  VertexId vertex_of(const CellLattice& lattice, int u, int v) {
    std::vector<NodeId> nodes;
    for (int w = 0; w <= lattice.elements[2]; ++w) nodes.push_back(lattice.node(u, v, w));
    const auto [known, is_new] = vertices_.try_emplace({nodes.front(), nodes.back()}, VertexId(sheet_.vertices.size()));
    if (is_new) sheet_.vertices.push_back({std::move(nodes)});
    return known->second;
  }

  Sheet sheet_;
  std::map<std::pair<NodeId, NodeId>, VertexId> vertices_;  // by base and apex
};

}  // namespace

void set_corners_and_lines(const CellLattice& lattice, const Vectors& rest_positions, Cell& cell) {
  set_corners_and_edges(lattice, rest_positions, cell);
  set_lines(lattice, cell);
}

Tissue tissue_from_lattices(const std::vector<CellLattice>& cells, Vectors rest_positions) {
  Tissue tissue;
  tissue.rest_positions = std::move(rest_positions);
  SheetOfLattices sheet;
  for (const CellLattice& lattice : cells) {
    sheet.add(lattice);
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
