#include "tissue/prisms.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <map>

#include "tissue/lattice.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

/// A place in a polygon: a vertex, the middle of an edge (its vertices, the lower first), or the middle of a cell.
struct Place {
  enum class Kind { vertex, edge, middle } kind;
  std::size_t first, second = 0;

  friend auto operator<=>(const Place&, const Place&) = default;
};

Place vertex(std::size_t v) { return {Place::Kind::vertex, v}; }
Place middle_of_edge(std::size_t a, std::size_t b) { return {Place::Kind::edge, std::min(a, b), std::max(a, b)}; }

class Builder {
 public:
  Builder(const PrismSheet& sheet, PolygonSplit split, int layers)
      : sheet_(sheet), hangs_(split == PolygonSplit::diagonals), layers_(layers) {}

  Tissue tissue() {
    for (std::size_t c = 0; c < sheet_.cells.size(); ++c) add_cell(c);
    number_free_nodes_first();
    for (Cell& cell : tissue_.cells) {
      set_polygons(cell);
      for (const NodeId corner : cell.corners) cell.rest_shape.push_back(tissue_.rest_positions[corner.index()]);
    }
    tissue_.regions["all"] = CellSet(tissue_.cells.size(), true);
    return std::move(tissue_);
  }

 private:
  [[nodiscard]] Vec3 at(const Place& place, double height) const {
    const auto of_vertex = [&](std::size_t v) {
      return Vec3((1 - height) * sheet_.basal[v] + height * sheet_.apical[v]);
    };
    switch (place.kind) {
      case Place::Kind::vertex:
        return of_vertex(place.first);
      case Place::Kind::edge:
        return 0.5 * (of_vertex(place.first) + of_vertex(place.second));
      case Place::Kind::middle:
        break;
    }
    Vec3 sum = Vec3::Zero();
    for (const std::size_t v : sheet_.cells[place.first]) sum += of_vertex(v);
    return sum / static_cast<double>(sheet_.cells[place.first].size());
  }

  [[nodiscard]] std::vector<OutlineQuad> split_of(const std::vector<std::size_t>& polygon) const {
    if (!hangs_) return split_into_kites(corners_of_polygon(polygon.size()));
    Vectors basal, apical;
    for (const std::size_t v : polygon) basal.push_back(sheet_.basal[v]), apical.push_back(sheet_.apical[v]);
    const PrismCorners prism{basal, apical};
    return best_split(corners_of_polygon(polygon.size()), [&](const auto& split) { return worst_part(prism, split); });
  }

  [[nodiscard]] Place place_of(const OutlinePlace& place, std::size_t cell) const {
    if (place.is_middle()) return {Place::Kind::middle, cell};
    const std::vector<std::size_t>& polygon = sheet_.cells[cell];
    const std::size_t from = polygon[place.wall], to = polygon[(place.wall + 1) % polygon.size()];
    if (place.at == 0) return {Place::Kind::vertex, from};
    return middle_of_edge(from, to);
  }

  // Originals of images.
  [[nodiscard]] Place original(const Place& place) const {
    const Periods& periods = sheet_.periods;
    if (place.kind == Place::Kind::vertex) return vertex(periods.original(place.first));
    if (place.kind == Place::Kind::middle) return place;
    return middle_of_edge(periods.original(place.first), periods.original(place.second));
  }

  NodeId node(const Place& place, int level) {
    const auto [known, is_new] = nodes_.try_emplace({place, level}, NodeId(tissue_.rest_positions.size()));
    const NodeId self = known->second;
    if (!is_new) return self;
    tissue_.rest_positions.push_back(at(place, static_cast<double>(level) / layers_));
    hanging_.emplace_back();
    shifts_.push_back(Vec3::Zero());
    if (hangs_ && place.kind != Place::Kind::vertex) {
      const std::vector<std::size_t> on =
          place.kind == Place::Kind::edge ? std::vector{place.first, place.second} : sheet_.cells[place.first];
      for (const std::size_t end : on) hang(self, node(vertex(end), level), 1.0 / static_cast<double>(on.size()));
      return self;
    }
    // The image that came first is the free one.
    const NodeId first = firsts_.try_emplace({original(place), level}, self).first->second;
    if (first == self) return self;
    Vec3& position = tissue_.rest_positions[self.index()];
    const Vec3& of_first = tissue_.rest_positions[first.index()];
    shifts_[self.index()] = sheet_.periods.whole(position - of_first);
    position = of_first + shifts_[self.index()];
    hang(self, first, 1);
    return self;
  }

  // On a node, or where that is an image, on what it is an image of.
  void hang(NodeId self, NodeId on, double weight) {
    if (const NodeMean& image = hanging_[on.index()]; !image.empty()) {
      shifts_[self.index()] += weight * shifts_[on.index()];
      on = image.front().first;
    }
    hanging_[self.index()].emplace_back(on, weight);
  }

  void add_cell(std::size_t c) {
    Cell cell;
    const std::vector<OutlineQuad> split = split_of(sheet_.cells[c]);
    if (divides()) cell.quadrilaterals = split;
    const CellId id(tissue_.cells.size());
    cell.first_element = ElementId(tissue_.elements.size());
    cell.element_count = static_cast<int>(split.size()) * layers_;
    cell.lineage.id = tissue_.next_cell_id++;
    for (int level = 0; level < layers_; ++level)
      for (const OutlineQuad& one : split) {
        std::array<NodeId, 8> element;
        for (int i = 0; i < 8; ++i) element[i] = node(place_of(one[i % 4], c), level + i / 4);
        add_element(element, id, level == 0, level == layers_ - 1, tissue_);
      }
    tissue_.cells.push_back(std::move(cell));
  }

  // Those that hang come last, all in the order in which elements came to them.
  void number_free_nodes_first() {
    std::vector<NodeId> now(hanging_.size());
    Vectors positions;
    for (const bool free : {true, false})
      for (std::size_t n = 0; n < hanging_.size(); ++n) {
        if (hanging_[n].empty() != free) continue;
        now[n] = NodeId(positions.size());
        positions.push_back(tissue_.rest_positions[n]);
        if (free) continue;
        for (auto& [on, weight] : hanging_[n]) on = now[on.index()];
        tissue_.hanging.push_back(hanging_[n]);
        if (sheet_.periods.is_used()) tissue_.hanging_shifts.push_back(shifts_[n]);
      }
    const auto renumber = [&](auto& nodes) {
      for (NodeId& one : nodes) one = now[one.index()];
    };
    for (auto& element : tissue_.elements) renumber(element);
    for (auto* facets : {&tissue_.apical_facets, &tissue_.basal_facets})
      for (Facet& facet : *facets) renumber(facet.nodes);
    for (auto& [place, number] : nodes_) number = now[number.index()];
    tissue_.rest_positions = std::move(positions);
  }

  // Data for division: nodes where division would put them, and no others.
  [[nodiscard]] bool divides() const { return hangs_ && layers_ == 1 && !sheet_.periods.is_used(); }

  // Corners, edges, lines and walls.
  void set_polygons(Cell& cell) {
    const std::vector<std::size_t>& polygon = sheet_.cells[static_cast<std::size_t>(cell.lineage.id)];
    const std::size_t n = polygon.size();
    PolygonChains chains;
    for (const int level : {0, layers_})
      for (std::size_t i = 0; i < n; ++i) {
        const std::size_t from = polygon[i], to = polygon[(i + 1) % n];
        std::vector<NodeId> chain = {node(vertex(from), level)};
        cell.corners.push_back(chain.front());
        if (!hangs_) chain.push_back(node(middle_of_edge(from, to), level));
        chain.push_back(node(vertex(to), level));
        (level == layers_ ? chains.apical : chains.basal).push_back(std::move(chain));
      }
    for (const std::size_t v : polygon) {
      std::vector<NodeId> chain;
      for (int level = 0; level <= layers_; ++level) chain.push_back(node(vertex(v), level));
      chains.lateral.push_back(std::move(chain));
    }
    set_polygon_edges(chains, tissue_.rest_positions, cell);
    if (divides()) cell.walls = walls_between_corners(cell);
  }

  const PrismSheet& sheet_;
  bool hangs_;
  int layers_;
  Tissue tissue_;
  std::map<std::pair<Place, int>, NodeId> nodes_;   // by place and level
  std::map<std::pair<Place, int>, NodeId> firsts_;  // by what they are images of
  std::vector<NodeMean> hanging_;                   // nodes; empty of free ones
  Vectors shifts_;                                  // nodes; as Tissue::hanging_shifts
};

}  // namespace

Tissue tissue_from_prisms(const PrismSheet& sheet, PolygonSplit split, int layers) {
  return Builder(sheet, split, layers).tissue();
}

}  // namespace plica
