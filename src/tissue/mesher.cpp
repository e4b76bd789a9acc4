#include "tissue/mesher.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "tissue/lattice.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

void add_vertex(VertexId vertex, double weight, VertexMean& sum) {
  const auto known = std::ranges::find(sum, vertex, &std::pair<VertexId, double>::first);
  if (known == sum.end())
    sum.emplace_back(vertex, weight);
  else
    known->second += weight;
}

std::vector<Side> closed_sides(const Polygon& polygon) {
  std::vector<Side> sides = polygon.sides();
  for (std::size_t s = 0; s < sides.size(); ++s)
    sides[s].push_back({sides[(s + 1) % sides.size()].front().vertex, {}, 1});
  return sides;
}

VertexId original(const Sheet& sheet, VertexId vertex) {
  const VertexId its = sheet.vertices[vertex.index()].original;
  return its.valid() ? its : vertex;
}

// Makes the mesh: of a tissue whose free nodes are known or, given the places of vertices, a first one.
class Mesher {
 public:
  Mesher(Tissue& tissue, const std::function<Vec3(VertexId, int)>* place) : tissue_(tissue), place_(place) {}

  void mesh() {
    tissue_.elements.clear();
    tissue_.element_cell.clear();
    tissue_.element_rest_shape.clear();
    tissue_.apical_facets.clear();
    tissue_.basal_facets.clear();
    tissue_.hanging.clear();
    tissue_.hanging_shifts.clear();
    for (Vertex& vertex : tissue_.sheet.vertices)
      if (vertex.original.valid()) vertex.nodes.assign(vertex.nodes.size(), NodeId());
    means_.resize(tissue_.rest_positions.size());
    shifts_.resize(means_.size(), Vec3::Zero());
    for (std::size_t c = 0; c < tissue_.cells.size(); ++c) add_cell(CellId(c));
    number_free_nodes_first();
    for (std::size_t c = 0; c < tissue_.cells.size(); ++c)
      if (!tissue_.cells[c].is_of_grid) set_corners_and_lines(CellId(c));
  }

 private:
  // Nodes where the lines of a patch cross, with their points on every level.
  struct PatchLattice : CellLattice {
    std::vector<VertexMean> points;
  };

  static PatchLattice lattice_of(const Patch& patch, std::size_t levels) {
    const std::vector<double> us = patch.lines(0), vs = patch.lines(1);
    PatchLattice lattice;
    lattice.elements = {static_cast<int>(us.size()) - 1, static_cast<int>(vs.size()) - 1, static_cast<int>(levels)};
    for (const double v : vs)
      for (const double u : us) lattice.points.push_back(patch.point(u, v));
    lattice.nodes.resize(lattice.points.size() * (levels + 1));
    return lattice;
  }

  NodeId node(PatchLattice& lattice, std::size_t point, std::size_t level) {
    NodeId& known = lattice.nodes[level * lattice.points.size() + point];
    if (!known.valid()) known = node(lattice.points[point], level);
    return known;
  }

  void add_cell(CellId id) {
    const Polygon& polygon = tissue_.sheet.cells[id.index()];
    const Outline outline(polygon);
    const std::size_t levels = tissue_.sheet.level_count(id);
    std::vector<PatchLattice> lattices;
    for (const OutlineQuad& quadrilateral : polygon.quadrilaterals)
      lattices.push_back(lattice_of(Patch(outline, quadrilateral), levels));
    if (place_ == nullptr)  // hanging nodes get numbers patch by patch
      for (PatchLattice& lattice : lattices)
        for (std::size_t level = 0; level <= levels; ++level)
          for (std::size_t point = 0; point < lattice.points.size(); ++point) node(lattice, point, level);

    Cell& cell = tissue_.cells[id.index()];
    cell.first_element = ElementId(tissue_.elements.size());
    for (std::size_t level = 0; level < levels; ++level)
      for (PatchLattice& lattice : lattices)
        for (int v = 0; v < lattice.elements[1]; ++v)
          for (int u = 0; u < lattice.elements[0]; ++u) {
            std::array<NodeId, 8> element;
            for (int i = 0; i < 8; ++i) {
              const Vec3& r = hex_reference_nodes[i];
              const int point = u + (r.x() > 0) + (lattice.elements[0] + 1) * (v + (r.y() > 0));
              element[i] = node(lattice, static_cast<std::size_t>(point), level + (r.z() > 0));
            }
            add_element(element, id, level == 0 && polygon.has_basal, level + 1 == levels && polygon.has_apical,
                        tissue_);
          }
    cell.element_count = static_cast<int>(tissue_.elements.size() - cell.first_element.index());
    if (cell.is_of_grid && lattices.size() == 1)
      plica::set_corners_and_lines(lattices.front(), tissue_.rest_positions, cell);
  }

  NodeId node(const VertexMean& on, std::size_t level) {
    if (on.size() == 1) {
      const std::size_t vertex = on.front().first.index();
      if (const NodeId known = tissue_.sheet.vertices[vertex].nodes[level]; known.valid()) return known;
      return tissue_.sheet.vertices[vertex].nodes[level] = new_node(on, level);
    }
    VertexMean key = on;
    std::ranges::sort(key);
    const auto known = hanging_.find({key, level});
    if (known != hanging_.end()) return known->second;
    const NodeId self = new_node(on, level);
    hanging_.emplace(std::pair(std::move(key), level), self);
    return self;
  }

  [[nodiscard]] bool is_periodic() const { return tissue_.period != Vec3::Zero(); }
  [[nodiscard]] Vec3 shift(VertexId vertex) const {
    const std::array<int, 3>& periods = tissue_.sheet.vertices[vertex.index()].periods;
    return tissue_.period.cwiseProduct(Vec3(periods[0], periods[1], periods[2]));
  }

  NodeId new_node(const VertexMean& on, std::size_t level) {
    const NodeId self(tissue_.rest_positions.size());
    means_.emplace_back();
    shifts_.push_back(Vec3::Zero());
    tissue_.rest_positions.push_back(Vec3::Zero());
    const bool is_image = on.size() == 1 && tissue_.sheet.vertices[on.front().first.index()].original.valid();
    Vec3 sum = Vec3::Zero();
    for (const auto& [vertex, weight] : on) {
      if (place_ != nullptr) sum += (*place_)(vertex, static_cast<int>(level));
      if (on.size() == 1 && !is_image) break;
      if (place_ != nullptr && on.size() > 1) node({{vertex, 1}}, level);  // what it hangs on gets numbers with it
      const NodeId end = node({{original(tissue_.sheet, vertex), 1}}, level);
      means_[self.index()].emplace_back(end, weight);
      shifts_[self.index()] += weight * shift(vertex);
    }
    NodeMean& mean = means_[self.index()];
    Vec3& position = tissue_.rest_positions[self.index()];
    if (place_ == nullptr) std::ranges::sort(mean);
    if (place_ != nullptr && !is_image) {
      position = sum / static_cast<double>(on.size());
    } else {
      position = mean_of(mean, tissue_.rest_positions);
      if (is_periodic()) position += shifts_[self.index()];
    }
    return self;
  }

  void number_free_nodes_first() {
    std::vector<NodeId> order;
    for (const bool is_free : {true, false})
      for (std::size_t n = 0; n < means_.size(); ++n) {
        if (means_[n].empty() != is_free) continue;
        order.emplace_back(n);
        if (is_free) continue;
        tissue_.hanging.push_back(std::move(means_[n]));
        if (is_periodic()) tissue_.hanging_shifts.push_back(shifts_[n]);
      }
    if (!std::ranges::is_sorted(order)) renumber(tissue_, order);
  }

  void set_corners_and_lines(CellId id) {
    const std::vector<Vertex>& vertices = tissue_.sheet.vertices;
    PolygonChains chains;
    for (const Side& side : closed_sides(tissue_.sheet.cells[id.index()])) {
      std::vector<NodeId> basal, apical;
      for (const Stop& stop : side) {
        basal.push_back(vertices[stop.vertex.index()].nodes.front());
        apical.push_back(vertices[stop.vertex.index()].nodes.back());
      }
      chains.basal.push_back(std::move(basal));
      chains.apical.push_back(std::move(apical));
      chains.lateral.push_back(vertices[side.front().vertex.index()].nodes);
    }
    Cell& cell = tissue_.cells[id.index()];
    cell.corners.clear();
    for (const auto* polygon : {&chains.basal, &chains.apical})
      for (const auto& chain : *polygon) cell.corners.push_back(chain.front());
    set_polygon_edges(chains, tissue_.rest_positions, cell);
  }

  Tissue& tissue_;
  const std::function<Vec3(VertexId, int)>* place_;
  std::vector<NodeMean> means_;  // nodes; empty of free ones
  Vectors shifts_;               // nodes; as Tissue::hanging_shifts
  std::map<std::pair<VertexMean, std::size_t>, NodeId> hanging_;
};

}  // namespace

Outline::Outline(const Polygon& polygon) : polygon_(polygon), sides_(closed_sides(polygon)) {}

void Outline::add(const OutlinePlace& place, double weight, VertexMean& sum) const {
  if (place.inner >= 0) return add_vertex(polygon_.inner[static_cast<std::size_t>(place.inner)], weight, sum);
  if (place.is_middle()) {
    for (const Side& side : sides_) add_vertex(side.front().vertex, weight / static_cast<double>(sides_.size()), sum);
    return;
  }
  const Side& side = sides_[static_cast<std::size_t>(place.wall)];
  const auto after = std::ranges::find_if(side, [&](const Stop& stop) { return stop.at >= place.at; });
  if (after->at == place.at) return add_vertex(after->vertex, weight, sum);
  const Stop &low = *(after - 1), &high = *after;
  const double part = (place.at - low.at) / (high.at - low.at);
  std::array<std::pair<VertexId, double>, 2> ends = {{{low.vertex, weight * (1 - part)}, {high.vertex, weight * part}}};
  std::ranges::sort(ends);  // the neighbour's order is the same
  for (const auto& [vertex, its] : ends) add_vertex(vertex, its, sum);
}

Patch::Patch(const Outline& outline, const OutlineQuad& corners)
    : outline_(outline),
      edges_{edge(corners[0], corners[1]), edge(corners[1], corners[2]), edge(corners[3], corners[2]),
             edge(corners[0], corners[3])} {}

Patch::Edge Patch::edge(const OutlinePlace& from, const OutlinePlace& to) const {
  const int sides = static_cast<int>(outline_.sides().size());
  const auto on = [&](const OutlinePlace& place, int side) -> std::optional<double> {
    if (place.wall == side) return place.at;
    if (!place.is_middle() && place.at == 0 && place.wall == (side + 1) % sides) return 1.0;
    return std::nullopt;
  };
  for (int side = 0; side < sides; ++side)
    if (const auto begin = on(from, side), end = on(to, side); begin && end) return {side, *begin, *end, {from, to}};
  return {std::nullopt, 0, 1, {from, to}};
}

std::vector<double> Patch::lines(int along) const {
  std::set<double> places = {0, 1};
  for (const Edge& edge : {edges_[along], edges_[along + 2]}) {
    if (!edge.side) continue;
    const double low = std::min(edge.from, edge.to), high = std::max(edge.from, edge.to);
    for (const Stop& stop : outline_.sides()[static_cast<std::size_t>(*edge.side)])
      if (stop.at > low && stop.at < high) places.insert((stop.at - edge.from) / (edge.to - edge.from));
  }
  return {places.begin(), places.end()};
}

std::vector<std::array<std::array<double, 2>, 2>> Patch::elements() const {
  const std::vector<double> us = lines(0), vs = lines(1);
  std::vector<std::array<std::array<double, 2>, 2>> elements;
  for (std::size_t v = 1; v < vs.size(); ++v)
    for (std::size_t u = 1; u < us.size(); ++u) elements.push_back({{{us[u - 1], vs[v - 1]}, {us[u], vs[v]}}});
  return elements;
}

VertexMean Patch::point(double u, double v) const {
  VertexMean sum;
  const auto add = [&](int edge, double at, double weight) { add_point(edges_[edge], at, weight, sum); };
  if (u == 0 || u == 1) {
    add(u == 0 ? 3 : 1, v, 1);
  } else if (v == 0 || v == 1) {
    add(v == 0 ? 0 : 2, u, 1);
  } else {
    add(0, u, 1 - v), add(2, u, v), add(3, v, 1 - u), add(1, v, u);
    add(0, 0, -(1 - u) * (1 - v)), add(0, 1, -u * (1 - v)), add(2, 0, -(1 - u) * v), add(2, 1, -u * v);
  }
  std::erase_if(sum, [](const auto& one) { return std::abs(one.second) < 1e-14; });
  return sum;
}

void Patch::add_point(const Edge& edge, double at, double weight, VertexMean& sum) const {
  if (edge.side) return outline_.add({*edge.side, edge.from + at * (edge.to - edge.from)}, weight, sum);
  if (at != 1) outline_.add(edge.ends[0], weight * (1 - at), sum);
  if (at != 0) outline_.add(edge.ends[1], weight * at, sum);
}

NodeMean nodes_of(const Sheet& sheet, const VertexMean& mean, std::size_t level) {
  NodeMean nodes;
  for (const auto& [vertex, weight] : mean)
    nodes.emplace_back(sheet.vertices[original(sheet, vertex).index()].nodes[level], weight);
  std::ranges::sort(nodes);
  return nodes;
}

void mesh(Tissue& tissue) {
  tissue.rest_positions.resize(tissue.free_node_count());
  Mesher(tissue, nullptr).mesh();
}

void mesh(Tissue& tissue, int layers, const std::function<Vec3(VertexId, int level)>& place, const Vec3& period) {
  tissue.period = period;
  for (Vertex& vertex : tissue.sheet.vertices) vertex.nodes.resize(static_cast<std::size_t>(layers) + 1);
  Mesher(tissue, &place).mesh();
}

void add_element(const std::array<NodeId, 8>& element, CellId id, bool is_basal, bool is_apical, Tissue& tissue) {
  const ElementId element_id(tissue.elements.size());
  tissue.elements.push_back(element);
  tissue.element_cell.push_back(id);
  tissue.element_rest_shape.push_back(gather(tissue.rest_positions, element));
  if (is_basal) tissue.basal_facets.push_back({{element[0], element[3], element[2], element[1]}, id, element_id});
  if (is_apical) tissue.apical_facets.push_back({{element[4], element[5], element[6], element[7]}, id, element_id});
}

void set_element_rest_shapes(Tissue& tissue, CellId id) {
  const Cell& cell = tissue.cells[id.index()];
  const Polygon& polygon = tissue.sheet.cells[id.index()];
  const Outline outline(polygon);
  const std::size_t levels = tissue.sheet.level_count(id);
  std::size_t element = cell.first_element.index();
  for (std::size_t level = 0; level < levels; ++level) {
    const double low = static_cast<double>(level) / static_cast<double>(levels),
                 high = static_cast<double>(level + 1) / static_cast<double>(levels);
    for (const OutlineQuad& quadrilateral : polygon.quadrilaterals) {
      const HexPoints shape = part_over(rest_prism(cell), quadrilateral);
      for (const auto& [from, to] : Patch(outline, quadrilateral).elements())
        tissue.element_rest_shape[element++] = hex_part(shape, Vec3(from[0], from[1], low), Vec3(to[0], to[1], high));
    }
  }
}

std::size_t element_count(const Sheet& sheet, CellId cell) {
  const Polygon& polygon = sheet.cells[cell.index()];
  const Outline outline(polygon);
  std::size_t count = 0;
  for (const OutlineQuad& quadrilateral : polygon.quadrilaterals)
    count += Patch(outline, quadrilateral).elements().size();
  return count * sheet.level_count(cell);
}

void keep_elements(Tissue& tissue, const std::vector<CellId>& kept) {
  std::vector<std::array<NodeId, 8>> elements;
  std::vector<CellId> element_cell, now(tissue.cells.size());
  std::vector<HexPoints> rest_shapes;
  std::vector<ElementId> element(tissue.elements.size());
  std::vector<Cell> cells;
  for (const CellId before : kept) {
    const CellId id = now[before.index()] = CellId(cells.size());
    Cell& cell = cells.emplace_back(std::move(tissue.cells[before.index()]));
    const std::size_t first = cell.first_element.index();
    cell.first_element = ElementId(elements.size());
    for (std::size_t e = first; e < first + cell.element_count; ++e) {
      element[e] = ElementId(elements.size());
      elements.push_back(tissue.elements[e]);
      element_cell.push_back(id);
      rest_shapes.push_back(tissue.element_rest_shape[e]);
    }
  }
  for (auto* facets : {&tissue.apical_facets, &tissue.basal_facets}) {
    std::erase_if(*facets, [&](const Facet& facet) { return !now[facet.cell.index()].valid(); });
    for (Facet& facet : *facets) facet = {facet.nodes, now[facet.cell.index()], element[facet.element.index()]};
  }
  tissue.cells = std::move(cells);
  tissue.elements = std::move(elements);
  tissue.element_cell = std::move(element_cell);
  tissue.element_rest_shape = std::move(rest_shapes);
}

void renumber(Tissue& tissue, const std::vector<NodeId>& before) {
  std::vector<NodeId> now(tissue.rest_positions.size());
  Vectors positions;
  for (const NodeId node : before) {
    now[node.index()] = NodeId(positions.size());
    positions.push_back(tissue.rest_positions[node.index()]);
  }
  tissue.rest_positions = std::move(positions);
  const auto pass = [&](auto& nodes) {
    for (NodeId& node : nodes)
      if (node.valid()) node = now[node.index()];
  };
  for (NodeMean& mean : tissue.hanging)
    for (auto& [node, weight] : mean) node = now[node.index()];
  for (auto& nodes : tissue.elements) pass(nodes);
  for (auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (Facet& facet : *facets) pass(facet.nodes);
  for (Vertex& vertex : tissue.sheet.vertices) pass(vertex.nodes);
  for (Cell& cell : tissue.cells) {
    pass(cell.corners);
    for (CellEdge& edge : cell.edges) pass(edge.nodes);
    for (CellLine& line : cell.lines) pass(line.chain.nodes);
  }
}

void number_as_elements_come(Tissue& tissue) {
  std::vector<char> is_known(tissue.node_count(), 0);
  std::vector<NodeId> order;
  for (const auto& nodes : tissue.elements)
    for (const NodeId node : nodes)
      if (std::exchange(is_known[node.index()], 1) == 0) order.push_back(node);
  renumber(tissue, order);
}

std::vector<NodeId> drop_unused_nodes(Tissue& tissue) {
  // Nodes that carry hanging nodes of a cell belong to the cell.
  std::vector<char> is_used(tissue.node_count(), 0);
  for (const auto& nodes : tissue.elements)
    for (const NodeId node : nodes) is_used[node.index()] = 1;
  std::vector<NodeId> before;
  std::vector<NodeMean> hanging;
  for (std::size_t n = 0; n < is_used.size(); ++n) {
    if (is_used[n] == 0) continue;
    before.emplace_back(n);
    if (n >= tissue.free_node_count()) hanging.push_back(std::move(tissue.hanging[n - tissue.free_node_count()]));
  }
  tissue.hanging = std::move(hanging);
  renumber(tissue, before);
  return before;
}

}  // namespace plica
