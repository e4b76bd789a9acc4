// Connected pieces of a mesh.
#pragma once

#include <string>
#include <vector>

namespace plica {

/// Pieces of things 0, 1, ... that are joined by neighbours.
struct Pieces {
  std::vector<std::size_t> piece_of;  // things: number of its piece, in order of their first things
  std::vector<std::size_t> sizes;     // pieces

  [[nodiscard]] bool is_one() const { return sizes.size() < 2; }
  /// Return the number of the largest piece, the first of equal ones.
  [[nodiscard]] std::size_t largest() const;
  /// Return "3 pieces of 60, 2 and 1 cells", the largest first.
  [[nodiscard]] std::string text(const char* things) const;
};

/// Return the pieces of `count` things. `for_neighbours(thing, take)` calls `take` with each neighbour; neighbours know
/// each other.
template <class ForNeighbours>
Pieces pieces_of(std::size_t count, const ForNeighbours& for_neighbours) {
  constexpr auto none = static_cast<std::size_t>(-1);
  Pieces pieces{std::vector(count, none), {}};
  std::vector<std::size_t> reached;
  for (std::size_t first = 0; first < count; ++first) {
    if (pieces.piece_of[first] != none) continue;
    reached.assign(1, first);
    pieces.piece_of[first] = pieces.sizes.size();
    for (std::size_t i = 0; i < reached.size(); ++i)
      for_neighbours(reached[i], [&](std::size_t next) {
        if (pieces.piece_of[next] != none) return;
        pieces.piece_of[next] = pieces.sizes.size();
        reached.push_back(next);
      });
    pieces.sizes.push_back(reached.size());
  }
  return pieces;
}

}  // namespace plica
