// A tissue that is symmetric about planes through the origin, and the one side of them that need be solved: what stands
// for what (docs/theory/mirror.md).
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Which node and cell of a side each of the whole is an image of. Empty: of a tissue that is a whole by itself, where
/// everything is its own image.
struct Mirror {
  /// Where that node is, times a sign an axis.
  struct Image {
    NodeId node;
    Vec3 signs;
  };
  std::vector<Image> nodes;     // of the whole
  std::vector<CellId> cells;    // of the whole
  std::vector<CellId> origins;  // of the side: which of the whole's its cells are

  [[nodiscard]] bool is_used() const { return !nodes.empty(); }
  [[nodiscard]] Image image(NodeId of_whole) const {
    return is_used() ? nodes[of_whole.index()] : Image{of_whole, Vec3::Ones()};
  }
  /// The cell of the whole, on the side, that a cell of the whole is an image of.
  [[nodiscard]] CellId own(CellId of_whole) const {
    return is_used() ? origins[cells[of_whole.index()].index()] : of_whole;
  }
  /// Vectors of a side's nodes (positions, or what turns as they do), of all nodes of the whole.
  [[nodiscard]] Vectors whole(std::span<const Vec3> of_side) const;
};

/// Vectors of a side's nodes, read by nodes of the whole.
struct MirroredVectors {
  const Mirror& mirror;
  std::span<const Vec3> of_side;
  [[nodiscard]] Vec3 operator[](std::size_t of_whole) const {
    const auto [node, signs] = mirror.image(NodeId(of_whole));
    return signs.cwiseProduct(of_side[node.index()]);
  }
};

/// A tissue is not symmetric about a plane. The text says which, and what is wrong.
struct NotSymmetric : std::runtime_error {
  NotSymmetric(const std::string& problem, std::string what_would_be_right)
      : std::runtime_error(problem), remedy(std::move(what_would_be_right)) {}
  std::string remedy;
};

/// The part of a whole on the positive side of the planes across some axes (0, 1, 2 for x, y, z), through the origin.
struct MirroredSide {
  Tissue tissue;
  Mirror mirror;
};

/// NotSymmetric when a node or cell has no image, when a plane cuts a cell in two, and of a periodic sheet.
MirroredSide side_of(const Tissue& whole, const std::array<bool, 3>& axes);

}  // namespace plica
