// Exchange of neighbours (T1): a lateral face turns by a quarter, from base to apex, so that the two cells beside it
// part and those at its ends meet. Nodes stay; the rings of four cells change, and those cells get new elements.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "tissue/remesher.hpp"

namespace plica {

/// Wall that can turn, and the cells about it. At a rim, one of those beyond `left` is missing (invalid).
struct WallTurn {
  WallId wall;
  CellId left, right;    // of the wall; they part
  CellId behind, ahead;  // at its beginning and its end, as `left` has it; they meet
  VertexId begin, end;   // its columns, as vertices of `left`

  [[nodiscard]] std::array<CellId, 4> cells() const { return {left, right, behind, ahead}; }
};

/// Return a reason why no wall of this tissue can turn, or empty.
std::optional<std::string> why_unturnable(const Tissue& tissue);

/// Return the walls that can turn, in order of cells. Both ends belong to three cells, or two at a rim; the cells that
/// part keep three sides, and do not part where both lie at a rim; those that meet do not touch elsewhere.
std::vector<WallTurn> possible_turns(const Sheet& sheet);

/// Return the vector from begin to end of a wall on a level: 0 at the base.
Vec3 wall_vector(const Tissue& tissue, const WallTurn& turn, std::size_t level, std::span<const Vec3> positions);

/// Return the mean length of the wall at base and apex, um.
double wall_length(const Tissue& tissue, const WallTurn& turn, std::span<const Vec3> positions);

/// Turn walls, of which no two share a cell, to this length, um. `positions`, um, change with the tissue: the columns
/// of a wall move to both sides of its middle. Turns that would leave bad elements are dropped from the list. The rest
/// shape of a cell about a wall is its present one, mapped by `unstretch`, with the volume it had; its stops become
/// corners. Reference positions of nodes stay, and mean nothing for the cells that have changed.
TissueChange turn_walls(Tissue& tissue, std::vector<WallTurn>& turns, double length_um, Vectors& positions,
                        const Unstretch& unstretch);

}  // namespace plica
