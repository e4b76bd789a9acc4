#include "tissue/prisms.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

// Mean of vertices: one, those of an edge in their order, or all of a cell.
using Place = std::vector<std::size_t>;

Place middle_of_edge(std::size_t a, std::size_t b) { return {std::min(a, b), std::max(a, b)}; }

class Builder {
 public:
  Builder(const PrismSheet& sheet, PolygonSplit split, int layers)
      : sheet_(sheet), hangs_(split == PolygonSplit::diagonals), layers_(layers) {
    for (std::size_t v = 0; v < sheet.basal.size(); ++v) vertex_of({v});
  }

  Tissue tissue() {
    for (std::size_t c = 0; c < sheet_.cells.size(); ++c) add_cell(c);
    tissue_.sheet.connect();
    mesh(
        tissue_, layers_,
        [&](VertexId vertex, int level) { return at(places_[vertex.index()], static_cast<double>(level) / layers_); },
        sheet_.periods.is_used() ? sheet_.periods.length : Vec3::Zero());
    for (Cell& cell : tissue_.cells)
      for (const NodeId corner : cell.corners) cell.rest_shape.push_back(tissue_.rest_positions[corner.index()]);
    tissue_.regions["all"] = CellSet(tissue_.cells.size(), true);
    return std::move(tissue_);
  }

 private:
  [[nodiscard]] Vec3 at(const Place& place, double height) const {
    const auto of_vertex = [&](std::size_t v) {
      return Vec3((1 - height) * sheet_.basal[v] + height * sheet_.apical[v]);
    };
    Vec3 sum = of_vertex(place.front());
    for (const std::size_t v : std::span(place).subspan(1)) sum += of_vertex(v);
    return sum / static_cast<double>(place.size());
  }

  [[nodiscard]] std::vector<OutlineQuad> split_of(const std::vector<std::size_t>& polygon) const {
    if (!hangs_) return split_into_kites(corners_of_polygon(polygon.size()));
    Vectors basal, apical;
    for (const std::size_t v : polygon) basal.push_back(sheet_.basal[v]), apical.push_back(sheet_.apical[v]);
    const PrismCorners prism{basal, apical};
    return best_split(corners_of_polygon(polygon.size()), [&](const auto& split) { return worst_part(prism, split); });
  }

  // What it is an image of.
  [[nodiscard]] Place original(Place place) const {
    for (std::size_t& v : place) v = sheet_.periods.original(v);
    std::ranges::sort(place);
    return place;
  }

  // Vertices keep their order; with kites there are some in the middles of edges and cells.
  VertexId vertex_of(const Place& place) {
    const auto [known, is_new] = vertices_.try_emplace(place, VertexId(places_.size()));
    if (is_new) {
      places_.push_back(place);
      tissue_.sheet.vertices.emplace_back();
    }
    return known->second;
  }

  // Of vertices that are images of each other, the one that comes first is free.
  void note(const Place& place) {
    const VertexId self = vertex_of(place), first = firsts_.try_emplace(original(place), self).first->second;
    if (first == self) return;
    Vertex& image = tissue_.sheet.vertices[self.index()];
    image.original = first;
    const Vec3 way = at(place, 0) - at(places_[first.index()], 0);
    for (int axis = 0; axis < 3; ++axis)
      if (const double length = sheet_.periods.length[axis]; length > 0)
        image.periods[axis] = static_cast<int>(std::round(way[axis] / length));
  }

  void note(const OutlinePlace& place, std::size_t c) {
    const std::vector<std::size_t>& polygon = sheet_.cells[c];
    if (place.is_middle()) {
      for (const std::size_t v : polygon) note({v});
      return;
    }
    const std::size_t from = polygon[place.wall], to = polygon[(place.wall + 1) % polygon.size()];
    if (place.at == 0) return note({from});
    if (!hangs_) return note(middle_of_edge(from, to));
    for (const std::size_t v : middle_of_edge(from, to)) note({v});
  }

  void add_cell(std::size_t c) {
    const std::vector<std::size_t>& vertices = sheet_.cells[c];
    Polygon polygon;
    polygon.quadrilaterals = split_of(vertices);
    for (OutlineQuad& one : polygon.quadrilaterals)
      for (OutlinePlace& place : one) {
        if (hangs_ || !place.is_middle())
          note(place, c);
        else
          place.inner = 0;
      }
    if (!hangs_) polygon.inner.push_back(vertex_of(vertices));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      polygon.ring.push_back({vertex_of({vertices[i]}), {}, 0});
      if (!hangs_)
        polygon.ring.push_back({vertex_of(middle_of_edge(vertices[i], vertices[(i + 1) % vertices.size()])), {}, 0.5});
    }
    tissue_.sheet.cells.push_back(std::move(polygon));
    tissue_.cells.emplace_back().lineage.id = tissue_.next_cell_id++;
  }

  const PrismSheet& sheet_;
  bool hangs_;
  int layers_;
  Tissue tissue_;
  std::map<Place, VertexId> vertices_, firsts_;  // by place; by what they are images of
  std::vector<Place> places_;                    // vertices
};

}  // namespace

Tissue tissue_from_prisms(const PrismSheet& sheet, PolygonSplit split, int layers) {
  return Builder(sheet, split, layers).tissue();
}

}  // namespace plica
