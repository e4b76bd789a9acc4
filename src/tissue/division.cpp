#include "tissue/division.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

// A cell of four corners that is its own quadrilateral. A cut through the middles of opposite walls follows its lines.
bool is_one_patch(const Polygon& polygon) { return polygon.quadrilaterals.size() == 1; }
bool follows_lines(const Polygon& polygon, const CellCut& cut) {
  return is_one_patch(polygon) && cut.second_wall == cut.first_wall + 2 && cut.is_through_middles();
}

// Crossings of lines of the cell with the cut, along u or v.
std::vector<double> lines_across(const Polygon& polygon, const CellCut& cut) {
  if (!follows_lines(polygon, cut)) return {};
  const Outline outline(polygon);
  return Patch(outline, polygon.quadrilaterals.front()).lines(1 - cut.first_wall);
}

// Part of a side, its places stretched to 0 to 1.
Side part_of(const Side& side, double from, double to) {
  Side part;
  for (const Stop& stop : side)
    if (stop.at >= from && stop.at < to)
      part.push_back({stop.vertex, stop.wall, rounded_place((stop.at - from) / (to - from))});
  return part;
}

// The side as the other cell sees it: `end` follows its last stop.
Side reversed(const Side& side, VertexId end) {
  Side back;
  for (std::size_t i = side.size(); i > 0; --i)
    back.push_back(i == side.size() ? Stop{end, side[i - 1].wall, 0}
                                    : Stop{side[i].vertex, side[i - 1].wall, 1 - side[i].at});
  return back;
}

// A cell of kites, whose middle is a node: a cut bends there. Through middles of sides it follows lines.
bool has_middle(const Polygon& polygon) { return polygon.inner.size() == 1; }

using QuadVertices = std::array<VertexId, 4>;

std::vector<QuadVertices> vertices_of_split(const Polygon& polygon) {
  const Outline outline(polygon);
  std::vector<QuadVertices> split;
  for (const OutlineQuad& one : polygon.quadrilaterals) {
    QuadVertices& vertices = split.emplace_back();
    for (int i = 0; i < 4; ++i) {
      VertexMean place;
      outline.add(one[i], 1, place);
      vertices[i] = place.front().first;
    }
  }
  return split;
}

// Of a mother's quadrilaterals those that are the daughter's.
void keep_split(const std::vector<QuadVertices>& of_mother, Polygon& daughter) {
  std::map<VertexId, OutlinePlace> places;
  int side = -1;
  for (const Stop& stop : daughter.ring) places[stop.vertex] = {side += stop.at == 0 ? 1 : 0, stop.at};
  daughter.quadrilaterals.clear();
  for (const QuadVertices& vertices : of_mother)
    if (std::ranges::all_of(vertices, [&](VertexId vertex) { return places.contains(vertex); }))
      daughter.quadrilaterals.push_back(
          {places.at(vertices[0]), places.at(vertices[1]), places.at(vertices[2]), places.at(vertices[3])});
}

/// Outline of each daughter: corners, or the lateral faces behind them.
template <class Item>
struct Rings {
  std::vector<Item> low, high;
};

// Rings of the daughters from the ring of the mother and new items: those of the low daughter follow from the first cut
// wall on; the high daughter takes the first and the others. Corner 0 belongs to the low one. Rotated so that the first
// kept item keeps its number; so cells of a grid keep their directions.
template <class Item>
Rings<Item> cut_ring(const CellCut& cut, std::span<const Item> ring, const std::vector<Item>& low,
                     const std::vector<Item>& high) {
  const auto first = ring.begin() + cut.first_wall, second = ring.begin() + cut.second_wall;
  Rings<Item> rings;
  rings.low.assign(ring.begin(), first);
  rings.low.insert(rings.low.end(), low.begin(), low.end());
  rings.low.insert(rings.low.end(), second + 1, ring.end());
  rings.high.push_back(high[0]);
  rings.high.insert(rings.high.end(), first + 1, second);
  rings.high.insert(rings.high.end(), high.begin() + 1, high.end());
  const auto turn = cut.first_wall % static_cast<std::ptrdiff_t>(rings.high.size());
  std::rotate(rings.high.begin(), rings.high.end() - turn, rings.high.end());
  return rings;
}

Rings<Vec3> cut_polygon(const CellCut& cut, std::span<const Vec3> corners, bool bends) {
  const auto corner = [&](int i) { return corners[static_cast<std::size_t>(i) % corners.size()]; };
  const Vec3 first = place_in(corners, {cut.first_wall, cut.first_at}),
             second = place_in(corners, {cut.second_wall, cut.second_at});
  std::vector<Vec3> low = {corner(cut.first_wall), first, second}, high = {first, corner(cut.second_wall), second};
  if (bends) {
    low.insert(low.begin() + 2, place_in(corners, {}));
    high.push_back(place_in(corners, {}));
  }
  return cut_ring<Vec3>(cut, corners, low, high);
}

// The cutting itself: sheet and rest shapes, without a mesh.
class Cutter {
 public:
  Cutter(Tissue& tissue, Vectors positions, TissueChange& change)
      : tissue_(tissue), sheet_(tissue.sheet), positions_(std::move(positions)), change_(change) {}

  // `lines`: where lines crossed the cut, before anything was cut.
  void cut(const CellCut& cut, const std::vector<double>& lines, double time_s) {
    const CellId a = cut.cell, b(tissue_.cells.size());
    const bool follows = follows_lines(sheet_.cells[a.index()], cut), bends = has_middle(sheet_.cells[a.index()]);
    const bool keeps = bends && cut.is_through_middles();
    const std::vector<QuadVertices> split =
        keeps ? vertices_of_split(sheet_.cells[a.index()]) : std::vector<QuadVertices>();
    part_polygon(cut, new_wall(cut, lines));
    tissue_.cells.push_back(tissue_.cells[a.index()]);
    Cell &low = tissue_.cells[a.index()], &high = tissue_.cells[b.index()];
    std::tie(low.rest_shape, high.rest_shape) = halves_of_prism(cut, std::vector(low.rest_shape), bends);
    for (const CellId daughter : {a, b}) {
      sheet_.cells[daughter.index()].inner.clear();
      if (keeps)
        keep_split(split, sheet_.cells[daughter.index()]);
      else if (!follows)
        to_split_.push_back(daughter);
    }
    const Lineage of_mother = low.lineage;
    for (Cell* daughter : {&low, &high})
      daughter->lineage = {tissue_.next_cell_id++, of_mother.id, of_mother.generation + 1, time_s};
    change_.origin.push_back(change_.origin[a.index()]);
    change_.daughters.push_back({a, b});
  }

  // After the last cut: all stops are there.
  void split_daughters() {
    for (const CellId id : to_split_) {
      Polygon& polygon = sheet_.cells[id.index()];
      const Outline outline(polygon);
      OutlineRing with_stops;
      int side = -1;
      for (const Stop& stop : polygon.ring) with_stops.push_back({side += stop.at == 0 ? 1 : 0, stop.at});
      polygon.quadrilaterals = best_split(
          corners_of_polygon(outline.sides().size()),
          [&](const auto& split) { return worst_element(id, outline, split); }, with_stops);
    }
  }

  // Worst element of all cells.
  [[nodiscard]] double quality() const {
    double worst = 1;
    for (std::size_t c = 0; c < sheet_.cells.size(); ++c)
      worst = std::min(worst, worst_element(CellId(c), Outline(sheet_.cells[c]), sheet_.cells[c].quadrilaterals));
    return worst;
  }

 private:
  VertexId new_vertex(const VertexMean& place) {
    Vertex vertex;
    const std::size_t levels = sheet_.vertices[place.front().first.index()].nodes.size();
    for (std::size_t level = 0; level < levels; ++level) {
      NodeMean nodes = nodes_of(sheet_, place, level);
      for (Vectors* places : {&tissue_.rest_positions, &positions_}) places->push_back(mean_of(nodes, *places));
      change_.new_nodes.push_back(std::move(nodes));
      vertex.nodes.emplace_back(tissue_.rest_positions.size() - 1);
    }
    sheet_.vertices.push_back(std::move(vertex));
    return VertexId(sheet_.vertices.size() - 1);
  }

  // Vertex at a place of a side; inserted into the wall there unless it is a stop. Stops come from halving: that of a
  // neighbour's cut is made on the way where it is missing.
  VertexId stop_at(CellId cell, int side, double at) {
    while (true) {
      const Side stops = Outline(sheet_.cells[cell.index()]).sides()[static_cast<std::size_t>(side)];
      const auto after = std::ranges::find_if(stops, [&](const Stop& stop) { return stop.at >= at; });
      if (after->at == at) return after->vertex;
      halve(*(after - 1), after->vertex);
    }
  }

  // Insert a vertex midway between a stop and the next.
  void halve(const Stop& low, VertexId high) {
    const VertexId vertex = new_vertex({{low.vertex, 0.5}, {high, 0.5}});
    const auto nodes = [&](VertexId one) { return std::span<const NodeId>(sheet_.vertices[one.index()].nodes); };
    for (std::size_t level = 0; level < nodes(vertex).size(); ++level)
      change_.node_midway.emplace(std::minmax(nodes(low.vertex)[level], nodes(high)[level]), nodes(vertex)[level]);
    sheet_.split_wall(low.wall, vertex);
    change_.wall_origin.push_back(change_.wall_origin[low.wall.index()]);
  }

  // New wall as sides of the low daughter, from the place on the first side to that on the second, where the last
  // vertex is. It has stops where it crosses lines at which the mother's faces bend, so it lies on them and the volume
  // is unchanged. A node in the middle of the mother becomes a corner, since the cut bends there.
  struct NewWall {
    std::vector<Side> sides;
    VertexId end;
  };
  NewWall new_wall(const CellCut& cut, const std::vector<double>& lines) {
    const VertexId from = stop_at(cut.cell, cut.first_wall, cut.first_at),
                   to = stop_at(cut.cell, cut.second_wall, cut.second_at);
    NewWall wall{{{{from, {}, 0}}}, to};
    const Polygon& mother = sheet_.cells[cut.cell.index()];
    if (has_middle(mother)) wall.sides.push_back({{mother.inner.front(), {}, 0}});
    const bool along_v = cut.first_wall == 0;  // from wall 0 to wall 2; else from wall 1 to wall 3, against u
    const Outline outline(mother);
    Side inner;
    for (const double at : lines) {
      if (at == 0 || at == 1) continue;
      const Patch patch(outline, mother.quadrilaterals.front());
      inner.push_back({new_vertex(along_v ? patch.point(0.5, at) : patch.point(at, 0.5)), {}, at});
    }
    if (!along_v) {
      std::ranges::reverse(inner);
      for (Stop& stop : inner) stop.at = 1 - stop.at;
    }
    wall.sides.back().insert(wall.sides.back().end(), inner.begin(), inner.end());
    return wall;
  }

  void part_polygon(const CellCut& cut, NewWall between) {
    const CellId a = cut.cell, b(sheet_.cells.size());
    for (Side& side : between.sides)
      for (Stop& stop : side) {
        stop.wall = sheet_.add_wall(a, b);
        change_.wall_origin.emplace_back();
      }
    std::vector<Side> back;
    for (std::size_t i = between.sides.size(); i > 0; --i)
      back.push_back(
          reversed(between.sides[i - 1], i < between.sides.size() ? between.sides[i].front().vertex : between.end));
    const std::vector<Side> sides = sheet_.cells[a.index()].sides();
    const Side &first = sides[static_cast<std::size_t>(cut.first_wall)],
               &second = sides[static_cast<std::size_t>(cut.second_wall)];
    std::vector<Side> low = {part_of(first, 0, cut.first_at)},
                      high = {part_of(first, cut.first_at, 1), part_of(second, 0, cut.second_at)};
    low.insert(low.end(), between.sides.begin(), between.sides.end());
    low.push_back(part_of(second, cut.second_at, 1));
    high.insert(high.end(), back.begin(), back.end());
    const Rings<Side> rings = cut_ring<Side>(cut, sides, low, high);
    sheet_.cells.push_back(sheet_.cells[a.index()]);
    sheet_.cells[a.index()].take_sides(rings.low);
    sheet_.cells[b.index()].take_sides(rings.high);
    for (const Stop& stop : sheet_.cells[b.index()].ring)
      for (CellId& cell : sheet_.walls[stop.wall.index()].cells)
        if (cell == a && sheet_.walls[stop.wall.index()].cells != std::array{a, b}) cell = b;
  }

  // Worst element of the cell with this split, in the reference state and at present.
  [[nodiscard]] double worst_element(CellId id, const Outline& outline, const std::vector<OutlineQuad>& split) const {
    double worst = 1;
    for (const OutlineQuad& quadrilateral : split) {
      const Patch patch(outline, quadrilateral);
      worst = std::min(worst, hex_scaled_jacobian(part_over(rest_prism(tissue_.cells[id.index()]), quadrilateral)));
      for (std::size_t level = 0; level < sheet_.level_count(id); ++level)
        for (const auto& part : patch.elements()) {
          HexPoints points;
          for (int i = 0; i < 8; ++i) {
            const Vec3& r = hex_reference_nodes[i];
            const VertexMean place = patch.point(part[r.x() > 0][0], part[r.y() > 0][1]);
            points[i] = mean_of(nodes_of(sheet_, place, level + (r.z() > 0)), positions_);
          }
          worst = std::min(worst, hex_scaled_jacobian(points));
        }
    }
    return worst;
  }

  Tissue& tissue_;
  Sheet& sheet_;
  Vectors positions_;
  TissueChange& change_;
  std::vector<CellId> to_split_;  // daughters that are no quadrilaterals
};

// A cell with its own vertices, without a mesh; `positions`: of its free nodes.
Tissue alone(const Tissue& tissue, CellId id, std::span<const Vec3> all, Vectors& positions) {
  Tissue one;
  Polygon polygon = tissue.sheet.cells[id.index()];
  std::map<VertexId, VertexId> numbers;
  const auto take = [&](VertexId& vertex) {
    const auto [known, is_new] = numbers.try_emplace(vertex, VertexId(one.sheet.vertices.size()));
    if (is_new) {
      Vertex& its = one.sheet.vertices.emplace_back(tissue.sheet.vertices[vertex.index()]);
      for (NodeId& node : its.nodes) {
        one.rest_positions.push_back(tissue.rest_positions[node.index()]);
        positions.push_back(all[node.index()]);
        node = NodeId(positions.size() - 1);
      }
    }
    vertex = known->second;
  };
  for (Stop& stop : polygon.ring) take(stop.vertex);
  for (VertexId& vertex : polygon.inner) take(vertex);
  one.sheet.cells.push_back(std::move(polygon));
  one.sheet.connect();
  one.cells.push_back(tissue.cells[id.index()]);
  return one;
}

}  // namespace

double quality_of_daughters(const Tissue& tissue, const CellCut& cut, std::span<const Vec3> positions) {
  Vectors places;
  Tissue one = alone(tissue, cut.cell, positions, places);
  TissueChange change = no_change(one);
  CellCut its = cut;
  its.cell = CellId(0);
  const std::vector<double> lines = lines_across(one.sheet.cells[0], its);
  Cutter cutter(one, std::move(places), change);
  cutter.cut(its, lines, 0);
  cutter.split_daughters();
  return cutter.quality();
}

std::pair<std::vector<Vec3>, std::vector<Vec3>> halves_of_prism(const CellCut& cut, const std::vector<Vec3>& corners,
                                                                bool bends) {
  const std::size_t sides = corners.size() / 2;
  Rings<Vec3> shapes = cut_polygon(cut, std::span(corners).first(sides), bends);
  const Rings<Vec3> apical = cut_polygon(cut, std::span(corners).last(sides), bends);
  shapes.low.insert(shapes.low.end(), apical.low.begin(), apical.low.end());
  shapes.high.insert(shapes.high.end(), apical.high.begin(), apical.high.end());
  return {std::move(shapes.low), std::move(shapes.high)};
}

bool cuts_bend(const Tissue& tissue, CellId cell) { return has_middle(tissue.sheet.cells[cell.index()]); }

std::optional<std::string> why_indivisible(const Tissue& tissue) {
  return tissue.is_periodic() ? "the tissue is periodic" : why_unchangeable(tissue);
}

std::optional<std::string> why_unchangeable(const Tissue& tissue) {
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Polygon& polygon = tissue.sheet.cells[c];
    if (polygon.quadrilaterals.empty()) return "its cells have elements that no split of polygons makes";
    if (tissue.cells[c].is_of_grid && !is_one_patch(polygon)) return "its cells have several elements each";
    if (!polygon.has_basal || !polygon.has_apical) return "it has more than one layer of cells";
  }
  return std::nullopt;
}

TissueChange divide(Tissue& tissue, std::span<const CellCut> cuts, double time_s, std::span<const Vec3> positions) {
  TissueChange change = no_change(tissue);
  tissue.rest_positions.resize(tissue.free_node_count());
  tissue.hanging.clear();

  // Lines as they were before the first cut: what is made does not depend on the cuts' order.
  std::vector<std::vector<double>> lines;
  for (const CellCut& cut : cuts) lines.push_back(lines_across(tissue.sheet.cells[cut.cell.index()], cut));
  const std::span<const Vec3> places = positions.empty() ? tissue.rest_positions : positions;
  Cutter cutter(tissue, Vectors(places.begin(), places.begin() + static_cast<std::ptrdiff_t>(change.kept_nodes())),
                change);
  for (std::size_t i = 0; i < cuts.size(); ++i) cutter.cut(cuts[i], lines[i], time_s);
  cutter.split_daughters();
  complete(tissue, change);
  return change;
}

void complete(Tissue& tissue, const TissueChange& change) {
  mesh(tissue);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) set_element_rest_shapes(tissue, CellId(c));
  follow(change, tissue);
}

}  // namespace plica
