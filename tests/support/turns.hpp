// Walls of a tissue that turn at random, and what must hold afterwards.
#pragma once

#include "support/testing.hpp"
#include "support/tissues.hpp"
#include "tissue/exchange.hpp"
#include "tissue/faces.hpp"

namespace plica::support {

inline Mat3 as_it_is(CellId) { return Mat3::Identity(); }

inline TissueChange turned(Tissue& tissue, std::vector<WallTurn>& turns, double length_um, Vectors& positions) {
  return turn_walls(tissue, turns, length_um, positions, as_it_is);
}

inline std::set<std::pair<CellId, CellId>> pairs_of(const Tissue& tissue) {
  std::set<std::pair<CellId, CellId>> pairs;
  const auto neighbours = wall_neighbours(tissue);
  for (std::size_t c = 0; c < neighbours.size(); ++c)
    for (const CellId other : neighbours[c]) pairs.insert(std::minmax(CellId(c), other));
  return pairs;
}

/// Walls and rings agree, and are those that the rings alone give.
inline void expect_symmetric(const Tissue& tissue) {
  for (std::size_t c = 0; c < tissue.sheet.cells.size(); ++c)
    for (const Stop& stop : tissue.sheet.cells[c].ring) {
      const auto& cells = tissue.sheet.walls[stop.wall.index()].cells;
      EXPECT_TRUE(cells[0] == CellId(c) || cells[1] == CellId(c));
    }
  Tissue again = tissue;
  again.sheet.connect();
  EXPECT_EQ(pairs_of(again), pairs_of(tissue));
}

/// Turns of walls chosen at random, no two of which share a cell.
inline std::vector<WallTurn> random_turns(const Tissue& tissue, std::size_t most, Random& random) {
  std::vector<WallTurn> possible = possible_turns(tissue.sheet), chosen;
  std::set<CellId> taken;
  while (!possible.empty() && chosen.size() < most) {
    const auto place = static_cast<std::size_t>(0.5 * (random.number() + 1) * static_cast<double>(possible.size()));
    const WallTurn turn = possible[std::min(place, possible.size() - 1)];
    std::erase_if(possible, [&](const WallTurn& one) { return one.wall == turn.wall; });
    if (std::ranges::any_of(turn.cells(), [&](CellId cell) { return taken.contains(cell); })) continue;
    for (const CellId cell : turn.cells())
      if (cell.valid()) taken.insert(cell);
    chosen.push_back(turn);
  }
  return chosen;
}

/// Moves each column a part of the way to the mean of those it shares walls with, without the rim.
inline void smooth(const Tissue& tissue, Vectors& positions) {
  Vectors ways(positions.size(), Vec3::Zero());
  std::vector<int> counts(positions.size(), 0);
  std::set<NodeId> at_rim;
  for (const Polygon& polygon : tissue.sheet.cells)
    for (std::size_t i = 0; i < polygon.ring.size(); ++i) {
      const auto &from = tissue.sheet.vertices[polygon.ring[i].vertex.index()].nodes,
                 &to = tissue.sheet.vertices[polygon.after(i).vertex.index()].nodes;
      for (std::size_t level = 0; level < from.size(); ++level) {
        const NodeId one = tissue.original(from[level]), other = tissue.original(to[level]);
        const Vec3 way = positions[to[level].index()] - positions[from[level].index()];
        ways[one.index()] += way, ways[other.index()] -= way;
        ++counts[one.index()], ++counts[other.index()];
        const auto& cells = tissue.sheet.walls[polygon.ring[i].wall.index()].cells;
        if (!cells[0].valid() || !cells[1].valid()) at_rim.insert({one, other});
      }
    }
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n)
    if (counts[n] > 0 && !at_rim.contains(NodeId(n))) positions[n] += 0.3 / counts[n] * ways[n];
  tissue.place_hanging_positions(positions);
}

}  // namespace plica::support
