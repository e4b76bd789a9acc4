// What readers and builders of tissues share: errors with places, placement of coordinates, connected pieces.
#pragma once

#include <fmt/format.h>

#include <array>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// Unusable mesh (a FileError). The text, which may have a format, names the cell and the problem; the file name is
/// added by readers of files (of_file).
class MeshError : public FileError {
 public:
  using FileError::FileError;
  template <class Item, class... Items>
  MeshError(fmt::format_string<Item, Items...> text, Item&& item, Items&&... items)
      : FileError(fmt::format(text, std::forward<Item>(item), std::forward<Items>(items)...)) {}
};

/// Return the result of `read`; a MeshError gets the name of the file.
template <class Read>
auto of_file(const std::filesystem::path& file, const Read& read) try {
  return read();
} catch (const MeshError& error) {
  throw MeshError("{}: {}", file.string(), error.what());
}

struct HexahedralMesh;
struct Tissue;

/// Return "(1.5, 0, -20) um".
std::string place_text(const Vec3& place);

/// Return "cell 12 at (1.5, 0, -20) um": the centre in the reference state, or the mean of its nodes.
std::string cell_at(const Tissue& tissue, CellId cell);
std::string cell_at(const HexahedralMesh& mesh, std::size_t cell);
/// Return likewise by number and nodes.
std::string cell_text(std::size_t cell, const HexahedralMesh& mesh, const std::array<NodeId, 8>& nodes);

/// Scale, rotation and position of coordinates from a file.
struct Placement {
  Vec3 scale = {1, 1, 1};       // along x, y, z
  Vec3 rotate_deg = {0, 0, 0};  // afterwards, about x, then y, then z
  bool centre = false;          // afterwards, move the centre to the origin

  /// Scale and rotate points.
  void turn(Vectors& points) const;
};

/// Move points by minus `centre`.
void move_to_origin(Vectors& points, const Vec3& centre);

/// Return for each point the first one in its place, within a tolerance, mostly the point itself. Only the points of
/// `numbers` are compared.
std::vector<std::size_t> first_in_place(const Vectors& points, std::vector<std::size_t> numbers, double tolerance_um);

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
