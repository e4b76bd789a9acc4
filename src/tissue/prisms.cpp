#include "tissue/prisms.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <limits>
#include <map>
#include <span>

#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

/// A place in a polygon: a vertex, the middle of an edge (its vertices, the lower first), or the middle of a cell.
struct Place {
  enum class Kind { vertex, edge, middle } kind;
  std::size_t first, second = 0;

  friend auto operator<=>(const Place&, const Place&) = default;
};

using Quadrilateral = std::array<Place, 4>;

Place vertex(std::size_t v) { return {Place::Kind::vertex, v}; }
Place middle_of_edge(std::size_t a, std::size_t b) { return {Place::Kind::edge, std::min(a, b), std::max(a, b)}; }

std::vector<Quadrilateral> kites(const std::vector<std::size_t>& polygon, std::size_t cell) {
  const std::size_t n = polygon.size();
  std::vector<Quadrilateral> result;
  for (std::size_t i = 0; i < n; ++i)
    result.push_back({vertex(polygon[i]), middle_of_edge(polygon[i], polygon[(i + 1) % n]),
                      Place{Place::Kind::middle, cell}, middle_of_edge(polygon[(i + n - 1) % n], polygon[i])});
  return result;
}

// By diagonals from the first of an even number of places.
std::vector<Quadrilateral> fan(const std::vector<Place>& places) {
  std::vector<Quadrilateral> result;
  for (std::size_t i = 1; i + 2 < places.size(); i += 2)
    result.push_back({places[0], places[i], places[i + 1], places[i + 2]});
  return result;
}

class Builder {
 public:
  Builder(const PrismSheet& sheet, PolygonSplit split, int layers)
      : sheet_(sheet), hangs_(split == PolygonSplit::diagonals), layers_(layers) {}

  Tissue tissue() {
    for (std::size_t c = 0; c < sheet_.cells.size(); ++c) add_cell(c);
    number_free_nodes_first();
    // Each cell has as many facets on either side: its elements, over the layers.
    std::size_t first = 0;
    for (Cell& cell : tissue_.cells) {
      set_corners(cell);
      const auto count = static_cast<std::size_t>(cell.element_count / layers_);
      complete_polygon(tissue_, std::span(tissue_.basal_facets).subspan(first, count),
                       std::span(tissue_.apical_facets).subspan(first, count), cell);
      first += count;
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

  [[nodiscard]] double worst(const std::vector<Quadrilateral>& split) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Quadrilateral& one : split) {
      HexPoints points;
      for (int i = 0; i < 8; ++i) points[i] = at(one[i % 4], i / 4);
      least = std::min(least, hex_scaled_jacobian(points));
    }
    return least;
  }

  [[nodiscard]] std::vector<Quadrilateral> split_of(std::size_t cell) const {
    const std::vector<std::size_t>& polygon = sheet_.cells[cell];
    const std::size_t n = polygon.size();
    if (!hangs_ || n == 3) return kites(polygon, cell);
    std::vector<Quadrilateral> best;
    double best_worst = -std::numeric_limits<double>::infinity();
    // From each vertex of an even polygon, from the middle of each edge of an odd one. Ways that differ by rounding
    // only are alike: the first is taken.
    for (std::size_t i = 0; i < n; ++i) {
      std::vector<Place> places;
      for (std::size_t k = 0; k < n; ++k) places.push_back(vertex(polygon[(i + k) % n]));
      if (n % 2 == 1) places.insert(places.begin(), middle_of_edge(polygon[i], polygon[(i + n - 1) % n]));
      std::vector<Quadrilateral> split = fan(places);
      const double worst_of_it = worst(split);
      if (worst_of_it <= best_worst + 1e-9) continue;
      best_worst = worst_of_it;
      best = std::move(split);
    }
    return best;
  }

  NodeId node(const Place& place, int level) {
    const auto [known, is_new] = nodes_.try_emplace({place, level}, NodeId(tissue_.rest_positions.size()));
    if (is_new) {
      tissue_.rest_positions.push_back(at(place, static_cast<double>(level) / layers_));
      hanging_.emplace_back();
      if (hangs_ && place.kind == Place::Kind::edge) {
        const NodeId self = known->second;
        for (const std::size_t end : {place.first, place.second}) {
          const NodeId on = node(vertex(end), level);
          hanging_[self.index()].emplace_back(on, 0.5);
        }
        return self;
      }
    }
    return known->second;
  }

  void add_cell(std::size_t c) {
    const std::vector<Quadrilateral> split = split_of(c);
    Cell cell;
    const CellId id(tissue_.cells.size());
    cell.first_element = ElementId(tissue_.elements.size());
    cell.element_count = static_cast<int>(split.size()) * layers_;
    cell.lineage.id = tissue_.next_cell_id++;
    for (int level = 0; level < layers_; ++level)
      for (const Quadrilateral& one : split) {
        std::array<NodeId, 8> element;
        for (int i = 0; i < 8; ++i) element[i] = node(one[i % 4], level + i / 4);
        const ElementId element_id(tissue_.elements.size());
        tissue_.elements.push_back(element);
        tissue_.element_cell.push_back(id);
        tissue_.element_rest_shape.push_back(gather(tissue_.rest_positions, element));
        if (level == 0)
          tissue_.basal_facets.push_back({{element[0], element[3], element[2], element[1]}, id, element_id});
        if (level == layers_ - 1)
          tissue_.apical_facets.push_back({{element[4], element[5], element[6], element[7]}, id, element_id});
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

  void set_corners(Cell& cell) {
    for (const int level : {0, layers_})
      for (const std::size_t v : sheet_.cells[static_cast<std::size_t>(cell.lineage.id)])
        cell.corners.push_back(node(vertex(v), level));
  }

  const PrismSheet& sheet_;
  bool hangs_;
  int layers_;
  Tissue tissue_;
  std::map<std::pair<Place, int>, NodeId> nodes_;  // by place and level
  std::vector<NodeMean> hanging_;                  // nodes; empty of free ones
};

}  // namespace

Tissue tissue_from_prisms(const PrismSheet& sheet, PolygonSplit split, int layers) {
  return Builder(sheet, split, layers).tissue();
}

}  // namespace plica
