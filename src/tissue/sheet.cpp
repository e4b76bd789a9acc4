#include "tissue/sheet.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tissue/mesh_input.hpp"

namespace plica {

double rounded_place(double at) {
  constexpr double unit = 1.0 / (std::int64_t{1} << 32);
  return unit * std::round(at / unit);
}

std::vector<Side> Polygon::sides() const {
  std::vector<Side> sides;
  for (const Stop& stop : ring) {
    if (stop.at == 0) sides.emplace_back();
    sides.back().push_back(stop);
  }
  return sides;
}

void Polygon::take_sides(const std::vector<Side>& sides) {
  ring.clear();
  for (const Side& side : sides) ring.insert(ring.end(), side.begin(), side.end());
}

WallId Sheet::add_wall(CellId left, CellId right) {
  walls.push_back({{left, right}});
  return WallId(walls.size() - 1);
}

void Sheet::connect() {
  walls.clear();
  const auto original = [&](VertexId vertex) {
    const VertexId its = vertices[vertex.index()].original;
    return its.valid() ? its : vertex;
  };
  std::map<std::pair<VertexId, VertexId>, WallId> known;  // by the ends in the direction of the left cell
  for (std::size_t c = 0; c < cells.size(); ++c)
    for (std::size_t i = 0; i < cells[c].ring.size(); ++i) {
      Stop& stop = cells[c].ring[i];
      const VertexId from = original(stop.vertex), to = original(cells[c].after(i).vertex);
      const auto other = known.find({to, from});
      if (other == known.end()) {
        stop.wall = add_wall(CellId(c));
        if (!known.emplace(std::pair(from, to), stop.wall).second)
          throw MeshError("cells {} and {} lie on the same side of a wall",
                          walls[known.at({from, to}).index()].cells[0].number(), c);
        continue;
      }
      stop.wall = other->second;
      Wall& wall = walls[stop.wall.index()];
      if (wall.cells[1].valid())
        throw MeshError("cells {}, {} and {} share one wall", wall.cells[0].number(), wall.cells[1].number(), c);
      wall.cells[1] = CellId(c);
    }
}

WallId Sheet::split_wall(WallId wall, VertexId vertex) {
  const auto [left, right] = walls[wall.index()].cells;
  const WallId beyond = add_wall(left, right);
  for (const CellId cell : {left, right}) {
    if (!cell.valid()) continue;
    Polygon& polygon = cells[cell.index()];
    const auto from = std::ranges::find(polygon.ring, wall, &Stop::wall);
    const double end = polygon.end_of(static_cast<std::size_t>(from - polygon.ring.begin()));
    Stop stop{vertex, beyond, 0.5 * (from->at + end)};
    if (cell == right) std::swap(from->wall, stop.wall);
    polygon.ring.insert(from + 1, stop);
  }
  return beyond;
}

void Sheet::keep(std::span<const CellId> kept) {
  std::vector<CellId> now(cells.size());
  std::vector<Polygon> polygons;
  for (const CellId cell : kept) {
    now[cell.index()] = CellId(polygons.size());
    polygons.push_back(std::move(cells[cell.index()]));
  }
  cells = std::move(polygons);
  for (Wall& wall : walls)
    for (CellId& cell : wall.cells)
      if (cell.valid()) cell = now[cell.index()];
}

Polygon& SheetOfColumns::add_cell(bool has_basal, bool has_apical) {
  sides_ = 0;
  places_.clear();
  Polygon& polygon = sheet_.cells.emplace_back();
  polygon.has_basal = has_basal;
  polygon.has_apical = has_apical;
  return polygon;
}

void SheetOfColumns::add_side(const std::vector<Column>& stops) {
  for (std::size_t i = 0; i < stops.size(); ++i) {
    const Stop stop{vertex_of(stops[i]), {}, rounded_place(static_cast<double>(i) / static_cast<double>(stops.size()))};
    sheet_.cells.back().ring.push_back(stop);
    places_[stop.vertex] = {sides_, stop.at};
  }
  ++sides_;
}

OutlinePlace SheetOfColumns::place(const Column& column) {
  const VertexId vertex = vertex_of(column);
  const auto [place, is_within] = places_.try_emplace(vertex);
  if (is_within) {
    std::vector<VertexId>& inner = sheet_.cells.back().inner;
    place->second.inner = static_cast<int>(inner.size());
    inner.push_back(vertex);
  }
  return place->second;
}

Sheet SheetOfColumns::sheet() {
  sheet_.connect();
  return std::move(sheet_);
}

VertexId SheetOfColumns::vertex_of(const Column& column) {
  const auto [known, is_new] = vertices_.try_emplace({column.front(), column.back()}, VertexId(sheet_.vertices.size()));
  if (is_new) sheet_.vertices.push_back({column});
  return known->second;
}

namespace {

bool is_consistent(const Polygon& polygon, const std::vector<Vertex>& vertices, std::size_t free_nodes,
                   bool has_images) {
  const auto is_known = [&](VertexId vertex) {
    if (!vertex.is_among(vertices.size())) return false;
    if (const VertexId original = vertices[vertex.index()].original; original.valid()) {
      if (!has_images || !original.is_among(vertices.size()) || vertices[original.index()].original.valid() ||
          vertices[original.index()].nodes.size() != vertices[vertex.index()].nodes.size())
        return false;
      vertex = original;
    }
    const auto& nodes = vertices[vertex.index()].nodes;
    return nodes.size() > 1 && nodes.size() == vertices[polygon.ring.front().vertex.index()].nodes.size() &&
           std::ranges::all_of(nodes, [&](NodeId node) { return node.is_among(free_nodes); });
  };
  if (polygon.ring.empty() || !polygon.ring.front().vertex.is_among(vertices.size()) || polygon.ring.front().at != 0)
    return false;
  int sides = 0;
  for (std::size_t i = 0; i < polygon.ring.size(); ++i) {
    const Stop& stop = polygon.ring[i];
    if (!is_known(stop.vertex) || !(stop.at < polygon.end_of(i))) return false;
    if (stop.at == 0) ++sides;
  }
  const auto is_on_it = [&](const OutlinePlace& place) {
    if (place.is_middle()) return place.inner < static_cast<int>(polygon.inner.size());
    return place.inner < 0 && place.wall < sides && place.at >= 0 && place.at <= 1;
  };
  for (const OutlineQuad& quadrilateral : polygon.quadrilaterals)
    if (!std::ranges::all_of(quadrilateral, is_on_it)) return false;
  return sides >= 3 && std::ranges::all_of(polygon.inner, is_known) && !polygon.quadrilaterals.empty() &&
         polygon.quadrilaterals.size() <= polygon.ring.size();
}

}  // namespace

bool is_consistent(const Sheet& sheet, std::size_t free_nodes, bool has_images) {
  return std::ranges::all_of(sheet.cells, [&](const Polygon& polygon) {
    return is_consistent(polygon, sheet.vertices, free_nodes, has_images);
  });
}

}  // namespace plica
