#include "tissue/exchange.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "tissue/division.hpp"

namespace plica {
namespace {

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
  [[nodiscard]] std::size_t place(VertexId vertex) const { return sheet_.original_of(vertex).index(); }
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

// Turns one wall after the other in the sheet.
class Turner {
 public:
  Turner(Tissue& tissue, Vectors& positions, double length_um, const Unstretch& unstretch)
      : tissue_(tissue),
        sheet_(tissue.sheet),
        positions_(positions),
        length_um_(length_um),
        remesher_(tissue, positions, unstretch) {}

  // Whether the cells have good elements afterwards; if not, all is as it was.
  bool turn(const WallTurn& turn) {
    const Wall before = sheet_.walls[turn.wall.index()];
    remesher_.begin(turn.cells(), std::array{turn.begin, turn.end});
    turn_rings(turn);
    move_columns(turn);
    if (remesher_.finish()) return true;
    sheet_.walls[turn.wall.index()] = before;
    return false;
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
        ring, [&](const Stop& stop) { return sheet_.original_of(stop.vertex) == sheet_.original_of(own); });
    std::array<int, 3> periods = sheet_.vertices[other.index()].periods;
    for (int axis = 0; axis < 3; ++axis)
      periods[axis] += sheet_.vertices[at->vertex.index()].periods[axis] - sheet_.vertices[own.index()].periods[axis];
    ring.insert(at, Stop{remesher_.image(sheet_.original_of(other), periods), wall, 0});
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

  Tissue& tissue_;
  Sheet& sheet_;
  Vectors& positions_;
  double length_um_;
  Remesher remesher_;
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

Vec3 wall_vector(const Tissue& tissue, const WallTurn& turn, std::size_t level, std::span<const Vec3> positions) {
  return place_of(tissue, turn.end, level, positions) - place_of(tissue, turn.begin, level, positions);
}

double wall_length(const Tissue& tissue, const WallTurn& turn, std::span<const Vec3> positions) {
  const std::size_t apex = tissue.sheet.level_count(turn.left);
  return 0.5 * (wall_vector(tissue, turn, 0, positions).norm() + wall_vector(tissue, turn, apex, positions).norm());
}

TissueChange turn_walls(Tissue& tissue, std::vector<WallTurn>& turns, double length_um, Vectors& positions,
                        const Unstretch& unstretch) {
  TissueChange change = no_change(tissue);
  change.remeshed.assign(tissue.cells.size(), false);
  const std::vector<double> volumes = rest_volumes(tissue);
  Turner turner(tissue, positions, length_um, unstretch);
  std::erase_if(turns, [&](const WallTurn& turn) { return !turner.turn(turn); });
  for (const WallTurn& turn : turns) {
    change.wall_origin[turn.wall.index()] = {};
    for (const CellId cell : turn.cells())
      if (cell.valid()) change.remeshed[cell.index()] = true;
  }
  complete_remeshed(tissue, change, unstretch, volumes, positions);
  return change;
}

}  // namespace plica
