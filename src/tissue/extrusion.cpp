#include "tissue/extrusion.hpp"

#include <algorithm>
#include <array>

#include "tissue/division.hpp"
#include "tissue/mesher.hpp"

namespace plica {
namespace {

CellId neighbour(const Sheet& sheet, CellId cell, std::size_t stop) {
  return sheet.walls[sheet.cells[cell.index()].ring[stop].wall.index()].beyond(cell);
}

// Takes out one cell after the other; cells and nodes keep their numbers.
class Remover {
 public:
  Remover(Tissue& tissue, Vectors& positions, const Unstretch& unstretch)
      : tissue_(tissue), sheet_(tissue.sheet), positions_(positions), remesher_(tissue, positions, unstretch) {}

  // Whether its neighbours have good elements afterwards; if not, all is as it was.
  bool take_out(CellId id) {
    const std::vector<Stop> ring = sheet_.cells[id.index()].ring;
    const std::array neighbours = {neighbour(sheet_, id, 0), neighbour(sheet_, id, 1), neighbour(sheet_, id, 2)};
    const std::array vertices = {ring[0].vertex, ring[1].vertex, ring[2].vertex};
    remesher_.begin(neighbours, vertices);
    const std::vector<NodeId>& kept = column(sheet_, vertices[0]);
    std::vector<Vec3> middles;
    for (std::size_t level = 0; level < kept.size(); ++level) {
      Vec3 sum = Vec3::Zero();
      for (const VertexId vertex : vertices) sum += place_of(tissue_, vertex, level, positions_) / 3;
      middles.push_back(sum - shift_of(tissue_, vertices[0]));
    }
    for (std::size_t level = 0; level < kept.size(); ++level) positions_[kept[level].index()] = middles[level];
    for (std::size_t i = 0; i < 3; ++i) join(neighbours[i], ring[i].wall, vertices[i], vertices[0]);
    if (!remesher_.finish()) return false;
    for (std::size_t i = 0; i < 3; ++i) {
      sheet_.walls[ring[i].wall.index()].cells = {};
      if (i > 0) dropped.push_back(sheet_.original_of(vertices[i]));
    }
    return true;
  }

  std::vector<VertexId> dropped;

 private:
  // Take the wall from the ring of a neighbour; where it ended, at `end`, is now the `kept` vertex. Both are given as
  // the cell that leaves has them.
  void join(CellId cell, WallId wall, VertexId end, VertexId kept) {
    std::vector<Stop>& ring = sheet_.cells[cell.index()].ring;
    const auto stop = static_cast<std::size_t>(std::ranges::find(ring, wall, &Stop::wall) - ring.begin());
    Stop& after = ring[(stop + 1) % ring.size()];
    std::array<int, 3> periods = sheet_.vertices[kept.index()].periods;
    for (int axis = 0; axis < 3; ++axis)
      periods[axis] += sheet_.vertices[after.vertex.index()].periods[axis] - sheet_.vertices[end.index()].periods[axis];
    after.vertex = remesher_.image(sheet_.original_of(kept), periods);
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(stop));
  }

  Tissue& tissue_;
  Sheet& sheet_;
  Vectors& positions_;
  Remesher remesher_;
};

}  // namespace

bool can_leave(const Sheet& sheet, CellId cell) {
  const Polygon& polygon = sheet.cells[cell.index()];
  if (polygon.ring.size() != 3) return false;
  const std::array neighbours = {neighbour(sheet, cell, 0), neighbour(sheet, cell, 1), neighbour(sheet, cell, 2)};
  for (std::size_t i = 0; i < 3; ++i) {
    const CellId one = neighbours[i], before = neighbours[(i + 2) % 3];
    if (!one.valid() || one == before || one == cell || sheet.cells[one.index()].ring.size() < 4) return false;
    // The wall that follows in the ring of `one` leads away from the column that it shares with `before`.
    const std::vector<Stop>& ring = sheet.cells[one.index()].ring;
    const auto stop =
        static_cast<std::size_t>(std::ranges::find(ring, polygon.ring[i].wall, &Stop::wall) - ring.begin());
    if (sheet.walls[ring[(stop + 1) % ring.size()].wall.index()].beyond(one) != before) return false;
  }
  return true;
}

TissueChange take_out(Tissue& tissue, std::vector<CellId>& cells, Vectors& positions, const Unstretch& unstretch) {
  const std::vector<double> volumes = rest_volumes(tissue);
  CellSet is_out(tissue.cells.size(), false), is_beside(tissue.cells.size(), false);
  std::vector<char> is_dropped(tissue.node_count(), 0);
  Remover remover(tissue, positions, unstretch);
  std::erase_if(cells, [&](CellId cell) {
    const std::array neighbours = {neighbour(tissue.sheet, cell, 0), neighbour(tissue.sheet, cell, 1),
                                   neighbour(tissue.sheet, cell, 2)};
    if (!remover.take_out(cell)) return true;
    is_out[cell.index()] = true;
    for (const CellId one : neighbours) is_beside[one.index()] = true;
    return false;
  });
  for (const VertexId vertex : remover.dropped) {
    for (const NodeId node : column(tissue.sheet, vertex)) is_dropped[node.index()] = 1;
    tissue.sheet.vertices[vertex.index()].nodes.clear();
  }

  TissueChange change = no_change(tissue);
  std::erase_if(change.origin, [&](CellId cell) { return is_out[cell.index()]; });
  for (const CellId origin : change.origin) change.remeshed.push_back(is_beside[origin.index()]);
  tissue.sheet.keep(change.origin);
  tissue.cells = inherited(change, tissue.cells);
  std::erase_if(change.node_origin, [&](NodeId node) { return is_dropped[node.index()] != 0; });
  std::vector<NodeId> before = change.node_origin;
  for (std::size_t n = tissue.free_node_count(); n < tissue.node_count(); ++n) before.emplace_back(n);
  renumber(tissue, before);
  Vectors kept;
  for (const NodeId node : change.node_origin) kept.push_back(positions[node.index()]);
  positions = std::move(kept);
  complete_remeshed(tissue, change, unstretch, volumes, positions);
  return change;
}

}  // namespace plica
