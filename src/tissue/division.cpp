#include "tissue/division.hpp"

#include <algorithm>
#include <set>

#include "tissue/faces.hpp"
#include "tissue/lattice.hpp"

namespace plica {
namespace {

constexpr double middle = 0.5;

std::pair<NodeId, NodeId> ordered(NodeId a, NodeId b) { return std::minmax(a, b); }

// The lines across a cell from two opposite walls: 0, their stops, 1.
std::vector<double> lines_across(const Cell& cell, int first_wall) {
  std::set<double> places;
  for (const int wall : {first_wall, first_wall + 2})
    for (const WallStop& stop : cell.walls[wall]) places.insert(stop.at);
  return {places.begin(), places.end()};
}

// Adds weight times the point of a wall at `at`: a stop, or between two.
void add_wall_point(const std::vector<WallStop>& wall, double at, bool apical, double weight,
                    std::map<NodeId, double>& mean) {
  const auto after = std::ranges::find_if(wall, [&](const WallStop& stop) { return stop.at >= at; });
  const auto add = [&](const WallStop& stop, double part) { mean[apical ? stop.apical : stop.basal] += part; };
  if (after->at == at) return add(*after, weight);
  const WallStop& before = *(after - 1);
  const double part = (at - before.at) / (after->at - before.at);
  add(before, weight * (1 - part));
  add(*after, weight * part);
}

// A point of the apical or basal face: on the bilinearly blended (Coons) patch between its four edges. On an edge it is
// the edge; where all edges are straight it is bilinear; between lines through the stops it is bilinear, too, so the
// elements are this face exactly. Places are dyadic, so that weights that cancel do so exactly.
NodeMean place_in_cell(const Cell& cell, double u, double v, bool apical) {
  std::map<NodeId, double> mean;
  add_wall_point(cell.walls[0], u, apical, 1 - v, mean);
  add_wall_point(cell.walls[2], u, apical, v, mean);
  add_wall_point(cell.walls[3], v, apical, 1 - u, mean);
  add_wall_point(cell.walls[1], v, apical, u, mean);
  add_wall_point(cell.walls[0], 0, apical, -(1 - u) * (1 - v), mean);
  add_wall_point(cell.walls[0], 1, apical, -u * (1 - v), mean);
  add_wall_point(cell.walls[2], 0, apical, -(1 - u) * v, mean);
  add_wall_point(cell.walls[2], 1, apical, -u * v, mean);
  NodeMean on;
  for (const auto& [node, weight] : mean)
    if (weight != 0) on.emplace_back(node, weight);
  return on;
}

// The cutting itself: walls, stops and rest shapes, without a mesh.
class Cutter {
 public:
  Cutter(Tissue& tissue, Division& division) : tissue_(tissue), division_(division) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      for (int wall = 0; wall < 4; ++wall) claim(c, wall);
  }

  // `lines`: where lines along the cut crossed the mother's walls beside it, before anything was cut.
  void cut(const CellCut& cut, const std::vector<double>& lines, double time_s) {
    const std::size_t a = cut.cell.index(), b = tissue_.cells.size();
    const int first = cut.first_wall, second = first + 2;
    // The walls beside the cut that go to each daughter: walls 3 and 1 across u, 0 and 2 across v.
    const int low_side = first == 0 ? 3 : 0, high_side = first == 0 ? 1 : 2;
    const std::vector<WallStop> new_wall = wall_through(a, first, lines);

    tissue_.cells.push_back(tissue_.cells[a]);
    Cell &low = tissue_.cells[a], &high = tissue_.cells[b];
    for (const int wall : {first, second}) {
      const auto whole = low.walls[wall];
      low.walls[wall] = half(whole, 0);
      high.walls[wall] = half(whole, middle);
    }
    low.walls[high_side] = new_wall;
    high.walls[low_side] = new_wall;
    for (const int wall : {first, second, high_side}) hand_over(a, b, wall);
    claim(a, high_side);
    claim(b, low_side);

    const Vec3 across = Vec3::Unit(first);
    const HexPoints mother = hexahedron(low.rest_shape),
                    low_part = hex_part(mother, Vec3::Zero(), Vec3::Ones() - middle * across),
                    high_part = hex_part(mother, middle * across, Vec3::Ones());
    low.rest_shape.assign(low_part.begin(), low_part.end());
    high.rest_shape.assign(high_part.begin(), high_part.end());
    const Lineage of_mother = low.lineage;
    for (Cell* daughter : {&low, &high})
      daughter->lineage = {tissue_.next_cell_id++, of_mother.id, of_mother.generation + 1, time_s};
    division_.origin.push_back(division_.origin[a]);
    division_.daughters.push_back({CellId(a), CellId(b)});
  }

 private:
  using Owner = std::pair<std::size_t, int>;  // cell, wall

  // The part of a chain that begins at `from` and is half as long, its places stretched to 0 to 1.
  static std::vector<WallStop> half(const std::vector<WallStop>& chain, double from) {
    std::vector<WallStop> part;
    for (const WallStop& stop : chain)
      if (stop.at >= from && stop.at <= from + middle) part.push_back({(stop.at - from) * 2, stop.basal, stop.apical});
    return part;
  }

  // Every segment of a chain, by its apical nodes.
  template <class Take>
  void for_segments(std::size_t cell, int wall, Take take) {
    const auto& chain = tissue_.cells[cell].walls[wall];
    for (std::size_t i = 1; i < chain.size(); ++i) take(owners_[ordered(chain[i - 1].apical, chain[i].apical)]);
  }
  void claim(std::size_t cell, int wall) {
    for_segments(cell, wall, [&](std::vector<Owner>& owners) { owners.emplace_back(cell, wall); });
  }
  void hand_over(std::size_t from, std::size_t to, int wall) {
    for_segments(to, wall, [&](std::vector<Owner>& owners) {
      std::replace(owners.begin(), owners.end(), Owner(from, wall), Owner(to, wall));
    });
  }

  NodeId new_node(NodeMean place) {
    tissue_.rest_positions.push_back(mean_of(place, tissue_.rest_positions));
    division_.new_nodes.push_back(std::move(place));
    return NodeId(tissue_.rest_positions.size() - 1);
  }
  NodeId new_node_midway(NodeId a, NodeId b) {
    const NodeId node = new_node({{a, middle}, {b, middle}});
    division_.node_midway.emplace(ordered(a, b), node);
    return node;
  }

  // The new wall, from the middle of one wall to that of the opposite one. Where the mother's faces bend along a line
  // it has a stop, so that it lies on them and no volume is won or lost.
  std::vector<WallStop> wall_through(std::size_t cell, int first, const std::vector<double>& lines) {
    const std::array<WallStop, 2> middles = {middle_stop(cell, first), middle_stop(cell, first + 2)};
    const auto [from, to] = first == 0 ? std::pair(middles[0], middles[1]) : std::pair(middles[1], middles[0]);
    std::vector<WallStop> wall = {{0, from.basal, from.apical}};
    for (const double at : lines) {
      if (at == 0 || at == 1) continue;
      const double u = first == 0 ? middle : at, v = first == 0 ? at : middle;
      const Cell& mother = tissue_.cells[cell];
      const NodeId basal = new_node(place_in_cell(mother, u, v, false));
      const NodeId apical = new_node(place_in_cell(mother, u, v, true));
      wall.push_back({at, basal, apical});
    }
    wall.push_back({1, to.basal, to.apical});
    return wall;
  }

  // The stop in the middle of a wall; put there, for all whose wall it is, unless a neighbour's cut did so before.
  // Stops come from halving, so one that is missing lies midway between two.
  WallStop middle_stop(std::size_t cell, int wall) {
    const auto& chain = tissue_.cells[cell].walls[wall];
    const auto after = std::ranges::find_if(chain, [](const WallStop& stop) { return stop.at >= middle; });
    if (after->at == middle) return *after;
    const WallStop low = *(after - 1), high = *after;
    const NodeId basal = new_node_midway(low.basal, high.basal);
    const NodeId apical = new_node_midway(low.apical, high.apical);
    const auto segment = owners_.extract(ordered(low.apical, high.apical));
    for (const auto& [owner, owner_wall] : segment.mapped()) {
      auto& stops = tissue_.cells[owner].walls[owner_wall];
      const auto place = std::ranges::find_if(
          stops, [&](const WallStop& stop) { return stop.apical == low.apical || stop.apical == high.apical; });
      stops.insert(place + 1, {0.5 * (place->at + (place + 1)->at), basal, apical});
    }
    owners_[ordered(low.apical, apical)] = segment.mapped();
    owners_[ordered(apical, high.apical)] = segment.mapped();
    return {middle, basal, apical};
  }

  Tissue& tissue_;
  Division& division_;
  std::map<std::pair<NodeId, NodeId>, std::vector<Owner>> owners_;  // of a wall's segments: one cell, or two
};

// Makes the mesh: a cell's elements lie between the lines through the stops of its walls.
class Mesher {
 public:
  explicit Mesher(Tissue& tissue) : tissue_(tissue) {}

  void mesh() {
    std::vector<CellLattice> lattices;
    for (const Cell& cell : tissue_.cells) lattices.push_back(lattice(cell));
    Tissue meshed = tissue_from_lattices(lattices, tissue_.rest_positions);
    tissue_.elements = std::move(meshed.elements);
    tissue_.element_cell = std::move(meshed.element_cell);
    tissue_.element_rest_shape = std::move(meshed.element_rest_shape);
    tissue_.apical_facets = std::move(meshed.apical_facets);
    tissue_.basal_facets = std::move(meshed.basal_facets);
    for (std::size_t c = 0; c < tissue_.cells.size(); ++c) {
      Cell &cell = tissue_.cells[c], &now = meshed.cells[c];
      cell.first_element = now.first_element;
      cell.element_count = now.element_count;
      cell.corners = now.corners;
      cell.edges = std::move(now.edges);
      cell.lines = std::move(now.lines);
    }
  }

 private:
  NodeId node(const Cell& cell, double u, double v, bool apical) {
    const NodeMean on = place_in_cell(cell, u, v, apical);
    if (on.size() == 1) return on.front().first;
    const auto [known, is_new] = hanging_.try_emplace(on, NodeId(tissue_.rest_positions.size()));
    if (is_new) {
      tissue_.rest_positions.push_back(mean_of(on, tissue_.rest_positions));
      tissue_.hanging.push_back(on);
    }
    return known->second;
  }

  CellLattice lattice(const Cell& cell) {
    const std::vector<double> us = lines_across(cell, 0), vs = lines_across(cell, 1);
    CellLattice lattice;
    lattice.elements = {static_cast<int>(us.size()) - 1, static_cast<int>(vs.size()) - 1, 1};
    for (const bool apical : {false, true})
      for (const double v : vs)
        for (const double u : us) lattice.nodes.push_back(node(cell, u, v, apical));
    return lattice;
  }

  Tissue& tissue_;
  std::map<NodeMean, NodeId> hanging_;
};

}  // namespace

void set_element_rest_shapes(Tissue& tissue, CellId id) {
  const Cell& cell = tissue.cells[id.index()];
  const std::vector<double> us = lines_across(cell, 0), vs = lines_across(cell, 1);
  const HexPoints shape = hexahedron(cell.rest_shape);
  std::size_t element = cell.first_element.index();
  for (std::size_t v = 1; v < vs.size(); ++v)
    for (std::size_t u = 1; u < us.size(); ++u)
      tissue.element_rest_shape[element++] = hex_part(shape, Vec3(us[u - 1], vs[v - 1], 0), Vec3(us[u], vs[v], 1));
}

std::optional<std::string> why_indivisible(const Tissue& tissue) {
  for (const Cell& cell : tissue.cells) {
    if (!cell.is_of_grid) return "its cells are polygons, and only cells of a grid divide so far";
    if (cell.walls[0].empty()) return "its cells have several elements each";
  }
  if (cell_between_layers(tissue)) return "it has more than one layer of cells";
  return std::nullopt;
}

Division divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s) {
  Division division;
  tissue.rest_positions.resize(tissue.free_node_count());
  tissue.hanging.clear();
  division.free_nodes_before = tissue.rest_positions.size();
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) division.origin.emplace_back(c);

  // Lines as they were before the first cut: what is made does not depend on the cuts' order.
  std::vector<std::vector<double>> lines;
  for (const CellCut& cut : cuts) lines.push_back(lines_across(tissue.cells[cut.cell.index()], 1 - cut.first_wall));
  Cutter cutter(tissue, division);
  for (std::size_t i = 0; i < cuts.size(); ++i) cutter.cut(cuts[i], lines[i], time_s);
  Mesher(tissue).mesh();
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) set_element_rest_shapes(tissue, CellId(c));
  for (auto& [name, cells] : tissue.regions) cells = inherited(division, cells);
  for (auto& [name, values] : tissue.cell_arrays) values = inherited(division, values);
  return division;
}

Vectors with_new_nodes(const Tissue& tissue, const Division& division, const Vectors& before) {
  Vectors after(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(division.free_nodes_before));
  for (const NodeMean& place : division.new_nodes) after.push_back(mean_of(place, after));
  after.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging(after);
  return after;
}

}  // namespace plica
