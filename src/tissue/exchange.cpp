#include "tissue/exchange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "tissue/division.hpp"
#include "tissue/mesher.hpp"
#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

constexpr double least_quality = 0.02;  // scaled Jacobian of new elements

VertexId original_of(const Sheet& sheet, VertexId vertex) {
  const VertexId its = sheet.vertices[vertex.index()].original;
  return its.valid() ? its : vertex;
}

std::size_t stop_of(const Polygon& polygon, WallId wall) {
  return static_cast<std::size_t>(std::ranges::find(polygon.ring, wall, &Stop::wall) - polygon.ring.begin());
}

// Finds walls that can turn: what each vertex is part of is counted once.
class Turns {
 public:
  explicit Turns(const Sheet& sheet) : sheet_(sheet), cells_(sheet.vertices.size(), 0), is_at_rim_(cells_.size(), 0) {
    for (const Polygon& polygon : sheet.cells)
      for (std::size_t i = 0; i < polygon.ring.size(); ++i) {
        const Stop &from = polygon.ring[i], &to = polygon.after(i);
        ++cells_[place(from.vertex)];
        const auto& [left, right] = sheet.walls[from.wall.index()].cells;
        if (!left.valid() || !right.valid()) is_at_rim_[place(from.vertex)] = is_at_rim_[place(to.vertex)] = 1;
      }
  }

  [[nodiscard]] std::optional<WallTurn> turn(CellId left, std::size_t stop) const {
    const Polygon& polygon = sheet_.cells[left.index()];
    const std::size_t sides = polygon.ring.size();
    const Stop& at = polygon.ring[stop];
    const WallTurn turn{.wall = at.wall,
                        .left = left,
                        .right = beyond(left, at.wall),
                        .behind = beyond(left, polygon.ring[(stop + sides - 1) % sides].wall),
                        .ahead = beyond(left, polygon.after(stop).wall),
                        .begin = at.vertex,
                        .end = polygon.after(stop).vertex};
    const std::array cells = turn.cells();
    if (std::ranges::count_if(cells, &CellId::valid) < 3) return std::nullopt;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].valid() && std::ranges::count(cells, cells[i]) > 1) return std::nullopt;
    for (const CellId cell : {turn.left, turn.right})
      if (cell.valid() && sheet_.cells[cell.index()].ring.size() < 4) return std::nullopt;
    for (const VertexId vertex : {turn.begin, turn.end})
      if (cells_[place(vertex)] != 3 - is_at_rim_[place(vertex)]) return std::nullopt;
    if (meet_elsewhere(turn)) return std::nullopt;
    return turn;
  }

 private:
  [[nodiscard]] std::size_t place(VertexId vertex) const { return original_of(sheet_, vertex).index(); }
  [[nodiscard]] CellId beyond(CellId cell, WallId wall) const { return sheet_.walls[wall.index()].beyond(cell); }

  // A cell that would come to the rim must not touch it already, or the tissue would hang together at one vertex.
  [[nodiscard]] bool meet_elsewhere(const WallTurn& turn) const {
    std::set<std::size_t> of_behind;
    if (turn.behind.valid())
      for (const Stop& stop : sheet_.cells[turn.behind.index()].ring) of_behind.insert(place(stop.vertex));
    const CellId alone = turn.ahead.valid() ? turn.behind.valid() ? CellId() : turn.ahead : turn.behind;
    if (alone.valid())
      return std::ranges::any_of(sheet_.cells[alone.index()].ring,
                                 [&](const Stop& stop) { return is_at_rim_[place(stop.vertex)] != 0; });
    return std::ranges::any_of(sheet_.cells[turn.ahead.index()].ring,
                               [&](const Stop& stop) { return of_behind.contains(place(stop.vertex)); });
  }

  const Sheet& sheet_;
  std::vector<int> cells_;  // vertices, by originals: cells there
  std::vector<char> is_at_rim_;
};

// Where a vertex is in a periodic tissue, from the place of its original.
Vec3 shift_of(const Tissue& tissue, VertexId vertex) {
  const auto& [x, y, z] = tissue.sheet.vertices[vertex.index()].periods;
  return tissue.period.cwiseProduct(Vec3(x, y, z));
}

Vec3 place_of(const Tissue& tissue, VertexId vertex, std::size_t level, std::span<const Vec3> positions) {
  return positions[column(tissue.sheet, vertex)[level].index()] + shift_of(tissue, vertex);
}

// Turns one wall after the other in the sheet.
class Turner {
 public:
  Turner(Tissue& tissue, Vectors& positions, double length_um)
      : tissue_(tissue), sheet_(tissue.sheet), positions_(positions), length_um_(length_um) {}

  // Whether the cells have good elements afterwards; if not, all is as it was.
  bool turn(const WallTurn& turn, const std::function<Mat3(CellId)>& unstretch) {
    const Wall wall = sheet_.walls[turn.wall.index()];
    std::vector<std::pair<CellId, Polygon>> polygons;
    for (const CellId cell : turn.cells())
      if (cell.valid()) polygons.emplace_back(cell, sheet_.cells[cell.index()]);
    std::vector<std::pair<NodeId, Vec3>> places;
    for (const VertexId vertex : {turn.begin, turn.end})
      for (const NodeId node : column(sheet_, vertex)) places.emplace_back(node, positions_[node.index()]);

    turn_rings(turn);
    move_columns(turn);
    if (std::ranges::all_of(polygons, [&](const auto& one) { return take_split(one.first, unstretch(one.first)); }))
      return true;
    sheet_.walls[turn.wall.index()] = wall;
    for (auto& [cell, polygon] : polygons) sheet_.cells[cell.index()] = std::move(polygon);
    for (const auto& [node, place] : places) positions_[node.index()] = place;
    return false;
  }

  void take_rest_shape(CellId id, const Mat3& unstretch) {
    Cell& cell = tissue_.cells[id.index()];
    cell.rest_shape = corners(id);
    for (Vec3& corner : cell.rest_shape) corner = unstretch * corner;
  }

 private:
  // `left` keeps the first column and `right` the last; each of the others gets the one it did not have.
  void turn_rings(const WallTurn& turn) {
    remove(turn.left, turn.wall);
    if (turn.right.valid()) remove(turn.right, turn.wall);
    if (turn.behind.valid()) insert(turn.behind, turn.begin, turn.end, turn.wall);
    if (turn.ahead.valid()) insert(turn.ahead, turn.end, turn.begin, turn.wall);
    sheet_.walls[turn.wall.index()].cells = {turn.ahead.valid() ? turn.ahead : turn.behind,
                                             turn.ahead.valid() ? turn.behind : CellId()};
    for (const CellId cell : turn.cells())
      if (cell.valid())
        for (Stop& stop : sheet_.cells[cell.index()].ring) stop.at = 0;
  }

  // Take the wall from a ring, with the vertex at its end.
  void remove(CellId cell, WallId wall) {
    std::vector<Stop>& ring = sheet_.cells[cell.index()].ring;
    const std::size_t stop = stop_of(sheet_.cells[cell.index()], wall), next = (stop + 1) % ring.size();
    ring[stop].wall = ring[next].wall;
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(next));
  }

  // Insert the wall in a ring, from the new vertex `other` to `own`, which it has. Both are given as `left` has them.
  void insert(CellId cell, VertexId own, VertexId other, WallId wall) {
    std::vector<Stop>& ring = sheet_.cells[cell.index()].ring;
    const auto at = std::ranges::find_if(
        ring, [&](const Stop& stop) { return original_of(sheet_, stop.vertex) == original_of(sheet_, own); });
    std::array<int, 3> periods = sheet_.vertices[other.index()].periods;
    for (int axis = 0; axis < 3; ++axis)
      periods[axis] += sheet_.vertices[at->vertex.index()].periods[axis] - sheet_.vertices[own.index()].periods[axis];
    ring.insert(at, Stop{image(original_of(sheet_, other), periods), wall, 0});
  }

  VertexId image(VertexId original, const std::array<int, 3>& periods) {
    if (periods == std::array<int, 3>{}) return original;
    const auto known = std::ranges::find_if(sheet_.vertices, [&](const Vertex& vertex) {
      return vertex.original == original && vertex.periods == periods;
    });
    if (known != sheet_.vertices.end()) return VertexId(static_cast<std::size_t>(known - sheet_.vertices.begin()));
    const std::size_t levels = sheet_.vertices[original.index()].nodes.size();
    sheet_.vertices.push_back({std::vector<NodeId>(levels), original, periods});
    return VertexId(sheet_.vertices.size() - 1);
  }

  void move_columns(const WallTurn& turn) {
    const std::size_t levels = column(sheet_, turn.begin).size();
    const auto place = [&](VertexId vertex, std::size_t level) { return place_of(tissue_, vertex, level, positions_); };
    const auto middle = [&](std::size_t level) {
      return Vec3(0.5 * (place(turn.begin, level) + place(turn.end, level)));
    };
    const Vec3 along =
        (wall_vector(tissue_, turn, 0, positions_) + wall_vector(tissue_, turn, levels - 1, positions_)).normalized();
    Vec3 up = middle(levels - 1) - middle(0);
    up -= up.dot(along) * along;
    const Vec3 half = 0.5 * length_um_ * up.normalized().cross(along);  // towards `left`
    for (std::size_t level = 0; level < levels; ++level) {
      const Vec3 at = middle(level);
      positions_[column(sheet_, turn.begin)[level].index()] = at + half - shift_of(tissue_, turn.begin);
      positions_[column(sheet_, turn.end)[level].index()] = at - half - shift_of(tissue_, turn.end);
    }
  }

  [[nodiscard]] std::vector<Vec3> corners(CellId cell) const {
    std::vector<Vec3> corners;
    for (const std::size_t level : {std::size_t{0}, sheet_.level_count(cell)})
      for (const Stop& stop : sheet_.cells[cell.index()].ring)
        corners.push_back(place_of(tissue_, stop.vertex, level, positions_));
    return corners;
  }

  bool take_split(CellId cell, const Mat3& unstretch) {
    const std::vector<Vec3> now = corners(cell);
    std::vector<Vec3> rest = now;
    for (Vec3& corner : rest) corner = unstretch * corner;
    const auto quality = [&](const std::vector<OutlineQuad>& split) {
      return std::min(worst_part(prism_of(now), split), worst_part(prism_of(rest), split));
    };
    Polygon& polygon = sheet_.cells[cell.index()];
    polygon.quadrilaterals = best_split(corners_of_polygon(polygon.ring.size()), quality);
    return quality(polygon.quadrilaterals) > least_quality;
  }

  Tissue& tissue_;
  Sheet& sheet_;
  Vectors& positions_;
  double length_um_;
};

}  // namespace

std::optional<std::string> why_unturnable(const Tissue& tissue) {
  if (const auto why = why_unchangeable(tissue)) return why;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (tissue.cells[c].is_of_grid) return "its cells are squares of a grid, of which four meet at a corner";
    if (!tissue.sheet.cells[c].inner.empty()) return "its cells are split into kites";
  }
  return std::nullopt;
}

std::vector<WallTurn> possible_turns(const Sheet& sheet) {
  const Turns turns(sheet);
  std::vector<WallTurn> possible;
  for (std::size_t c = 0; c < sheet.cells.size(); ++c)
    for (std::size_t stop = 0; stop < sheet.cells[c].ring.size(); ++stop) {
      const CellId right = sheet.walls[sheet.cells[c].ring[stop].wall.index()].beyond(CellId(c));
      if (right.valid() && right < CellId(c)) continue;
      if (const auto turn = turns.turn(CellId(c), stop)) possible.push_back(*turn);
    }
  return possible;
}

const std::vector<NodeId>& column(const Sheet& sheet, VertexId vertex) {
  return sheet.vertices[original_of(sheet, vertex).index()].nodes;
}

Vec3 wall_vector(const Tissue& tissue, const WallTurn& turn, std::size_t level, std::span<const Vec3> positions) {
  return place_of(tissue, turn.end, level, positions) - place_of(tissue, turn.begin, level, positions);
}

double wall_length(const Tissue& tissue, const WallTurn& turn, std::span<const Vec3> positions) {
  const std::size_t apex = tissue.sheet.level_count(turn.left);
  return 0.5 * (wall_vector(tissue, turn, 0, positions).norm() + wall_vector(tissue, turn, apex, positions).norm());
}

TissueChange turn_walls(Tissue& tissue, std::vector<WallTurn>& turns, double length_um, Vectors& positions,
                        const std::function<Mat3(CellId)>& unstretch) {
  TissueChange change = no_change(tissue);
  change.remeshed.assign(tissue.cells.size(), false);
  Turner turner(tissue, positions, length_um);
  std::erase_if(turns, [&](const WallTurn& turn) { return !turner.turn(turn, unstretch); });
  std::vector<std::pair<CellId, double>> volumes;
  for (const WallTurn& turn : turns) {
    change.wall_origin[turn.wall.index()] = {};
    for (const CellId cell : turn.cells()) {
      if (!cell.valid()) continue;
      change.remeshed[cell.index()] = true;
      volumes.emplace_back(cell, rest_volume(tissue, tissue.cells[cell.index()]));
      turner.take_rest_shape(cell, unstretch(cell));
    }
  }
  complete(tissue, change);
  for (const auto& [id, volume] : volumes) {
    Cell& cell = tissue.cells[id.index()];
    const double factor = std::cbrt(volume / rest_volume(tissue, cell));
    for (Vec3& corner : cell.rest_shape) corner *= factor;
    set_element_rest_shapes(tissue, id);
  }
  positions.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging_positions(positions);
  return change;
}

}  // namespace plica
