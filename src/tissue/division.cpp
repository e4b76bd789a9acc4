#include "tissue/division.hpp"

#include <algorithm>
#include <functional>
#include <set>
#include <tuple>

#include "tissue/faces.hpp"
#include "tissue/lattice.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

constexpr double middle = 0.5;

std::pair<NodeId, NodeId> ordered(NodeId a, NodeId b) { return std::minmax(a, b); }

using Weights = std::map<NodeId, double>;

NodeMean mean_by(const Weights& weights) {
  NodeMean on;
  for (const auto& [node, weight] : weights)
    if (weight != 0) on.emplace_back(node, weight);
  return on;
}

// Add weight times the point of a wall at `at`: a stop, or interpolated between two.
void add_wall_point(const std::vector<WallStop>& wall, double at, bool apical, double weight, Weights& sum) {
  const auto after = std::ranges::find_if(wall, [&](const WallStop& stop) { return stop.at >= at; });
  const auto add = [&](const WallStop& stop, double part) { sum[apical ? stop.apical : stop.basal] += part; };
  if (after->at == at) return add(*after, weight);
  const WallStop& before = *(after - 1);
  const double part = (at - before.at) / (after->at - before.at);
  add(before, weight * (1 - part));
  add(*after, weight * part);
}

// Quadrilateral of a cell: u from its first corner to the second, v from the first to the last. Sides are parts of
// walls, bent at stops, or straight between two places.
class Patch {
 public:
  Patch(const Cell& cell, const OutlineQuad& corners)
      : cell_(cell),
        sides_{side(corners[0], corners[1]), side(corners[1], corners[2]), side(corners[3], corners[2]),
               side(corners[0], corners[3])} {}

  // Coordinates u (0) or v (1) of element lines: 0, stops on the two sides along it, 1.
  [[nodiscard]] std::vector<double> lines(int along) const {
    std::set<double> places = {0, 1};
    for (const Side& side : {sides_[along], sides_[along + 2]}) {
      if (!side.wall) continue;
      const double low = std::min(side.from, side.to), high = std::max(side.from, side.to);
      for (const WallStop& stop : cell_.walls[*side.wall])
        if (stop.at > low && stop.at < high) places.insert((stop.at - side.from) / (side.to - side.from));
    }
    return {places.begin(), places.end()};
  }

  // Point of the apical or basal face: on the bilinearly blended (Coons) patch of the four sides. It coincides with the
  // sides and is bilinear between lines through the stops, so elements represent the face exactly. Coordinates are
  // dyadic, so weights that cancel do so exactly.
  [[nodiscard]] NodeMean point(double u, double v, bool apical) const {
    Weights sum;
    const auto add = [&](int side, double at, double weight) { add_side_point(sides_[side], at, apical, weight, sum); };
    if (u == 0 || u == 1) {
      add(u == 0 ? 3 : 1, v, 1);
    } else if (v == 0 || v == 1) {
      add(v == 0 ? 0 : 2, u, 1);
    } else {
      add(0, u, 1 - v), add(2, u, v), add(3, v, 1 - u), add(1, v, u);
      add(0, 0, -(1 - u) * (1 - v)), add(0, 1, -u * (1 - v)), add(2, 0, -(1 - u) * v), add(2, 1, -u * v);
    }
    return mean_by(sum);
  }

 private:
  struct Side {
    std::optional<int> wall;  // on it
    double from = 0, to = 1;  // there
    std::array<OutlinePlace, 2> ends;
  };

  [[nodiscard]] Side side(const OutlinePlace& from, const OutlinePlace& to) const {
    const int walls = static_cast<int>(cell_.walls.size());
    const auto on = [&](const OutlinePlace& place, int wall) -> std::optional<double> {
      if (place.wall == wall) return place.at;
      if (!place.is_middle() && place.at == 0 && place.wall == (wall + 1) % walls) return 1.0;
      return std::nullopt;
    };
    for (int wall = 0; wall < walls; ++wall)
      if (const auto begin = on(from, wall), end = on(to, wall); begin && end) return {wall, *begin, *end, {from, to}};
    return {std::nullopt, 0, 1, {from, to}};
  }

  void add_place(const OutlinePlace& place, bool apical, double weight, Weights& sum) const {
    if (!place.is_middle()) return add_wall_point(cell_.walls[place.wall], place.at, apical, weight, sum);
    for (const auto& wall : cell_.walls)
      add_wall_point(wall, 0, apical, weight / static_cast<double>(cell_.walls.size()), sum);
  }
  void add_side_point(const Side& side, double at, bool apical, double weight, Weights& sum) const {
    if (side.wall)
      return add_wall_point(cell_.walls[*side.wall], side.from + at * (side.to - side.from), apical, weight, sum);
    if (at != 1) add_place(side.ends[0], apical, weight * (1 - at), sum);
    if (at != 0) add_place(side.ends[1], apical, weight * at, sum);
  }

  const Cell& cell_;
  std::array<Side, 4> sides_;
};

// A cell of four corners that is its own quadrilateral. A cut through opposite walls follows its lines.
bool is_one_patch(const Cell& cell) { return cell.quadrilaterals.size() == 1; }
bool follows_lines(const Cell& cell, const CellCut& cut) {
  return is_one_patch(cell) && cut.second_wall == cut.first_wall + 2;
}

// Crossings of lines of the cell with the cut, along u or v.
std::vector<double> lines_across(const Cell& cell, const CellCut& cut) {
  if (!follows_lines(cell, cut)) return {};
  return Patch(cell, cell.quadrilaterals.front()).lines(1 - cut.first_wall);
}

// A chain's half that begins at `from`, its places stretched to 0 to 1.
std::vector<WallStop> half_from(double from, const std::vector<WallStop>& chain) {
  std::vector<WallStop> part;
  for (const WallStop& stop : chain)
    if (stop.at >= from && stop.at <= from + middle) part.push_back({(stop.at - from) * 2, stop.basal, stop.apical});
  return part;
}

std::vector<WallStop> reversed(std::vector<WallStop> chain) {
  std::ranges::reverse(chain);
  for (WallStop& stop : chain) stop.at = 1 - stop.at;
  return chain;
}

/// Outline of each daughter: corners, or the lateral faces behind them.
template <class Item>
struct Rings {
  std::vector<Item> low, high;
};

// Rings of the daughters from the ring of the mother and three new items each: those of the low daughter follow from
// the first cut wall on; the high daughter takes the first and the last two. Corner 0 belongs to the low one.
// Rotated so that the first kept item keeps its number; so cells of a grid keep their directions.
template <class Item>
Rings<Item> cut_ring(const CellCut& cut, std::span<const Item> ring, const std::array<Item, 3>& low,
                     const std::array<Item, 3>& high) {
  const auto first = ring.begin() + cut.first_wall, second = ring.begin() + cut.second_wall;
  Rings<Item> rings;
  rings.low.assign(ring.begin(), first);
  rings.low.insert(rings.low.end(), low.begin(), low.end());
  rings.low.insert(rings.low.end(), second + 1, ring.end());
  rings.high.push_back(high[0]);
  rings.high.insert(rings.high.end(), first + 1, second);
  rings.high.insert(rings.high.end(), high.begin() + 1, high.end());
  const auto turn = cut.first_wall % static_cast<std::ptrdiff_t>(rings.high.size());
  std::ranges::rotate(rings.high, rings.high.end() - turn);
  return rings;
}

Rings<Vec3> cut_polygon(const CellCut& cut, std::span<const Vec3> corners) {
  const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i) % corners.size()]; };
  const auto middle_of = [&](int wall) { return Vec3(middle * corner(wall) + middle * corner(wall + 1)); };
  const Vec3 first = middle_of(cut.first_wall), second = middle_of(cut.second_wall);
  return cut_ring<Vec3>(cut, corners, {corner(cut.first_wall), first, second},
                        {first, corner(cut.second_wall), second});
}

// The cutting itself: walls, stops and rest shapes, without a mesh.
class Cutter {
 public:
  Cutter(Tissue& tissue, Vectors positions, Division& division)
      : tissue_(tissue), positions_(std::move(positions)), division_(division) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) claim(c);
  }

  // `lines`: where lines crossed the cut, before anything was cut.
  void cut(const CellCut& cut, const std::vector<double>& lines, double time_s) {
    const std::size_t a = cut.cell.index(), b = tissue_.cells.size();
    const std::vector<WallStop> new_wall = wall_through(cut, lines);
    disclaim(a);
    tissue_.cells.push_back(tissue_.cells[a]);
    Cell &low = tissue_.cells[a], &high = tissue_.cells[b];
    const auto &first = high.walls[cut.first_wall], &second = high.walls[cut.second_wall];
    Rings<std::vector<WallStop>> walls =
        cut_ring<std::vector<WallStop>>(cut, high.walls, {half_from(0, first), new_wall, half_from(middle, second)},
                                        {half_from(middle, first), half_from(0, second), reversed(new_wall)});
    low.walls = std::move(walls.low);
    high.walls = std::move(walls.high);
    std::tie(low.rest_shape, high.rest_shape) = halves_of_prism(cut, std::vector(low.rest_shape));
    if (!follows_lines(high, cut)) to_split_.insert(to_split_.end(), {a, b});
    claim(a);
    claim(b);
    const Lineage of_mother = low.lineage;
    for (Cell* daughter : {&low, &high})
      daughter->lineage = {tissue_.next_cell_id++, of_mother.id, of_mother.generation + 1, time_s};
    division_.origin.push_back(division_.origin[a]);
    division_.daughters.push_back({CellId(a), CellId(b)});
  }

  // After the last cut: all stops are there.
  void split_daughters() {
    for (const std::size_t c : to_split_) {
      Cell& cell = tissue_.cells[c];
      OutlineRing with_stops;
      for (std::size_t wall = 0; wall < cell.walls.size(); ++wall)
        for (const WallStop& stop : cell.walls[wall])
          if (stop.at < 1) with_stops.push_back({static_cast<int>(wall), stop.at});
      cell.quadrilaterals = best_split(
          corners_of_polygon(cell.walls.size()), [&](const auto& split) { return worst_element(cell, split); },
          with_stops);
    }
  }

 private:
  using Owner = std::pair<std::size_t, std::size_t>;  // cell, wall

  // Every segment of the cell's walls, by its apical nodes.
  template <class Take>
  void for_segments(std::size_t cell, Take take) {
    const auto& walls = tissue_.cells[cell].walls;
    for (std::size_t wall = 0; wall < walls.size(); ++wall)
      for (std::size_t i = 1; i < walls[wall].size(); ++i)
        take(owners_[ordered(walls[wall][i - 1].apical, walls[wall][i].apical)], wall);
  }
  void claim(std::size_t cell) {
    for_segments(cell, [&](std::vector<Owner>& owners, std::size_t wall) { owners.emplace_back(cell, wall); });
  }
  void disclaim(std::size_t cell) {
    for_segments(cell, [&](std::vector<Owner>& owners, std::size_t) {
      std::erase_if(owners, [&](const Owner& owner) { return owner.first == cell; });
    });
  }

  NodeId new_node(NodeMean place) {
    for (Vectors* places : {&tissue_.rest_positions, &positions_}) places->push_back(mean_of(place, *places));
    division_.new_nodes.push_back(std::move(place));
    return NodeId(tissue_.rest_positions.size() - 1);
  }
  NodeId new_node_midway(NodeId a, NodeId b) {
    const NodeId node = new_node({{a, middle}, {b, middle}});
    division_.node_midway.emplace(ordered(a, b), node);
    return node;
  }

  // New wall, from the middle of the first wall to that of the second. It has stops where it crosses lines at which the
  // mother's faces bend, so it lies on them and the volume is unchanged.
  std::vector<WallStop> wall_through(const CellCut& cut, const std::vector<double>& lines) {
    const WallStop from = middle_stop(cut.cell, cut.first_wall), to = middle_stop(cut.cell, cut.second_wall);
    const bool along_v = cut.first_wall == 0;  // from wall 0 to wall 2; else from wall 1 to wall 3, against u
    std::vector<WallStop> inner;
    for (const double at : lines) {
      if (at == 0 || at == 1) continue;
      const Cell& mother = tissue_.cells[cut.cell.index()];
      const Patch patch(mother, mother.quadrilaterals.front());
      const double u = along_v ? middle : at, v = along_v ? at : middle;
      const NodeId basal = new_node(patch.point(u, v, false));
      const NodeId apical = new_node(patch.point(u, v, true));
      inner.push_back({at, basal, apical});
    }
    if (!along_v) inner = reversed(std::move(inner));
    std::vector<WallStop> wall = {{0, from.basal, from.apical}};
    wall.insert(wall.end(), inner.begin(), inner.end());
    wall.push_back({1, to.basal, to.apical});
    return wall;
  }

  // Stop in the middle of a wall; inserted for both cells of the wall unless an earlier cut of a neighbour did so.
  // Stops come from halving, so a missing one lies midway between two.
  WallStop middle_stop(CellId cell, int wall) {
    const auto& chain = tissue_.cells[cell.index()].walls[wall];
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

  // Worst element of the cell with this split, in the reference state and at present.
  [[nodiscard]] double worst_element(const Cell& cell, const std::vector<OutlineQuad>& split) const {
    double worst = 1;
    for (const OutlineQuad& quadrilateral : split) {
      const Patch patch(cell, quadrilateral);
      worst = std::min(worst, hex_scaled_jacobian(part_over(rest_prism(cell), quadrilateral)));
      const std::vector<double> us = patch.lines(0), vs = patch.lines(1);
      const auto at = [&](double u, double v, bool apical) { return mean_of(patch.point(u, v, apical), positions_); };
      for (std::size_t v = 1; v < vs.size(); ++v)
        for (std::size_t u = 1; u < us.size(); ++u) {
          HexPoints points;
          for (int i = 0; i < 8; ++i)
            points[i] = at(us[u - (hex_reference_nodes[i].x() > 0 ? 0 : 1)],
                           vs[v - (hex_reference_nodes[i].y() > 0 ? 0 : 1)], hex_reference_nodes[i].z() > 0);
          worst = std::min(worst, hex_scaled_jacobian(points));
        }
    }
    return worst;
  }

  Tissue& tissue_;
  Vectors positions_;
  Division& division_;
  std::map<std::pair<NodeId, NodeId>, std::vector<Owner>> owners_;  // of a wall's segments: one cell, or two
  std::vector<std::size_t> to_split_;                               // daughters that are no quadrilaterals
};

// Makes the mesh: the elements of a cell's quadrilateral lie between the lines through the stops of its walls.
class Mesher {
 public:
  explicit Mesher(Tissue& tissue) : tissue_(tissue) {}

  void mesh() {
    tissue_.elements.clear();
    tissue_.element_cell.clear();
    tissue_.element_rest_shape.clear();
    tissue_.apical_facets.clear();
    tissue_.basal_facets.clear();
    for (std::size_t c = 0; c < tissue_.cells.size(); ++c) {
      Cell& cell = tissue_.cells[c];
      cell.first_element = ElementId(tissue_.elements.size());
      for (const OutlineQuad& quadrilateral : cell.quadrilaterals) {
        const CellLattice nodes = lattice(Patch(cell, quadrilateral));
        add_elements_and_facets(nodes, CellId(c), tissue_);
        if (cell.is_of_grid) set_corners_and_lines(nodes, tissue_.rest_positions, cell);
      }
      cell.element_count = static_cast<int>(tissue_.elements.size() - cell.first_element.index());
      if (!cell.is_of_grid) set_corners_and_lines_of_walls(tissue_.rest_positions, cell);
      set_element_rest_shapes(tissue_, CellId(c));
    }
  }

 private:
  NodeId node(const NodeMean& on) {
    if (on.size() == 1) return on.front().first;
    const auto [known, is_new] = hanging_.try_emplace(on, NodeId(tissue_.rest_positions.size()));
    if (is_new) {
      tissue_.rest_positions.push_back(mean_of(on, tissue_.rest_positions));
      tissue_.hanging.push_back(on);
    }
    return known->second;
  }

  CellLattice lattice(const Patch& patch) {
    const std::vector<double> us = patch.lines(0), vs = patch.lines(1);
    CellLattice lattice;
    lattice.elements = {static_cast<int>(us.size()) - 1, static_cast<int>(vs.size()) - 1, 1};
    for (const bool apical : {false, true})
      for (const double v : vs)
        for (const double u : us) lattice.nodes.push_back(node(patch.point(u, v, apical)));
    return lattice;
  }

  Tissue& tissue_;
  std::map<NodeMean, NodeId> hanging_;
};

}  // namespace

std::pair<std::vector<Vec3>, std::vector<Vec3>> halves_of_prism(const CellCut& cut, const std::vector<Vec3>& corners) {
  const std::size_t sides = corners.size() / 2;
  Rings<Vec3> shapes = cut_polygon(cut, std::span(corners).first(sides));
  const Rings<Vec3> apical = cut_polygon(cut, std::span(corners).last(sides));
  shapes.low.insert(shapes.low.end(), apical.low.begin(), apical.low.end());
  shapes.high.insert(shapes.high.end(), apical.high.begin(), apical.high.end());
  return {std::move(shapes.low), std::move(shapes.high)};
}

void set_element_rest_shapes(Tissue& tissue, CellId id) {
  const Cell& cell = tissue.cells[id.index()];
  std::size_t element = cell.first_element.index();
  for (const OutlineQuad& quadrilateral : cell.quadrilaterals) {
    const Patch patch(cell, quadrilateral);
    const std::vector<double> us = patch.lines(0), vs = patch.lines(1);
    const HexPoints shape = part_over(rest_prism(cell), quadrilateral);
    for (std::size_t v = 1; v < vs.size(); ++v)
      for (std::size_t u = 1; u < us.size(); ++u)
        tissue.element_rest_shape[element++] = hex_part(shape, Vec3(us[u - 1], vs[v - 1], 0), Vec3(us[u], vs[v], 1));
  }
}

std::optional<std::string> why_indivisible(const Tissue& tissue) {
  if (tissue.is_periodic()) return "the tissue is periodic";
  for (const Cell& cell : tissue.cells)
    if (cell.walls.empty())
      return cell.is_of_grid ? "its cells have several elements each"
                             : "its cells consist of kites or of several layers of elements";
  if (cell_between_layers(tissue)) return "it has more than one layer of cells";
  return std::nullopt;
}

Division divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s, std::span<const Vec3> positions) {
  Division division;
  tissue.rest_positions.resize(tissue.free_node_count());
  tissue.hanging.clear();
  division.free_nodes_before = tissue.rest_positions.size();
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) division.origin.emplace_back(c);

  // Lines as they were before the first cut: what is made does not depend on the cuts' order.
  std::vector<std::vector<double>> lines;
  for (const CellCut& cut : cuts) lines.push_back(lines_across(tissue.cells[cut.cell.index()], cut));
  const std::span<const Vec3> places = positions.empty() ? tissue.rest_positions : positions;
  Cutter cutter(tissue, Vectors(places.begin(), places.begin() + division.free_nodes_before), division);
  for (std::size_t i = 0; i < cuts.size(); ++i) cutter.cut(cuts[i], lines[i], time_s);
  cutter.split_daughters();
  complete(tissue, division);
  return division;
}

void complete(Tissue& tissue, const Division& division) {
  Mesher(tissue).mesh();
  for (auto& [name, cells] : tissue.regions) cells = inherited(division, cells);
  for (auto& [name, values] : tissue.cell_arrays) values = inherited(division, values);
}

bool is_consistent(const Cell& cell, std::size_t free_nodes) {
  const std::size_t walls = cell.walls.size();
  std::size_t stops = 0;
  for (std::size_t wall = 0; wall < walls; ++wall) {
    const auto &chain = cell.walls[wall], &next = cell.walls[(wall + 1) % walls];
    const auto is_known = [&](const WallStop& stop) {
      return stop.basal.is_among(free_nodes) && stop.apical.is_among(free_nodes);
    };
    if (chain.size() < 2 || next.empty() || !std::ranges::all_of(chain, is_known) || chain.front().at != 0 ||
        chain.back().at != 1 ||
        std::ranges::adjacent_find(chain, std::ranges::greater_equal{}, &WallStop::at) != chain.end() ||
        chain.back().basal != next.front().basal || chain.back().apical != next.front().apical)
      return false;
    stops += chain.size() - 1;
  }
  const auto is_on_outline = [&](const OutlinePlace& place) {
    return place.is_middle() || (static_cast<std::size_t>(place.wall) < walls && place.at >= 0 && place.at <= 1);
  };
  for (const OutlineQuad& quadrilateral : cell.quadrilaterals)
    if (!std::ranges::all_of(quadrilateral, is_on_outline)) return false;
  const bool is_split = !cell.quadrilaterals.empty() && cell.quadrilaterals.size() <= stops;
  return walls >= 3 && is_split && (!cell.is_of_grid || (walls == 4 && is_one_patch(cell))) &&
         cell.rest_shape.size() == 2 * walls;
}

std::size_t element_count(const Cell& cell) {
  std::size_t count = 0;
  for (const OutlineQuad& quadrilateral : cell.quadrilaterals) {
    const Patch patch(cell, quadrilateral);
    count += (patch.lines(0).size() - 1) * (patch.lines(1).size() - 1);
  }
  return count;
}

Vectors with_new_nodes(const Tissue& tissue, const Division& division, const Vectors& before) {
  Vectors after(before.begin(), before.begin() + static_cast<std::ptrdiff_t>(division.free_nodes_before));
  for (const NodeMean& place : division.new_nodes) after.push_back(mean_of(place, after));
  after.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging(after);
  return after;
}

}  // namespace plica
