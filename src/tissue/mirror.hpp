// Parts of a tissue: some of its cells; and the solved side of a symmetric tissue, its planes through the origin, and
// the mapping of the full tissue to the side (docs/theory/mirror.md).
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "tissue/tissue_change.hpp"

namespace plica {

/// Keep only the given cells, with their elements and facets; nodes stay, used or not.
TissueChange keep_only(Tissue& tissue, const CellSet& cells);

/// Mapping of nodes and cells of the full tissue to those of a side. Empty for a tissue without mirror planes, where
/// everything is its own image.
struct Mirror {
  /// Original of a node, with one sign per axis.
  struct Image {
    NodeId node;
    Vec3 signs;
  };
  /// A reflection of the full tissue onto itself, in one plane or in several.
  struct Reflection {
    Vec3 signs;
    std::vector<NodeId> nodes;  // images of the nodes
  };
  std::vector<Image> nodes;             // full tissue
  std::vector<CellId> cells;            // full tissue
  std::vector<CellId> origins;          // side: cells of the full tissue
  std::vector<Reflection> reflections;  // the identity, then their products: 2, 4 or 8

  [[nodiscard]] bool is_used() const { return !nodes.empty(); }
  [[nodiscard]] Image image(NodeId of_whole) const {
    return is_used() ? nodes[of_whole.index()] : Image{of_whole, Vec3::Ones()};
  }
  /// Return the cell on the side of which a cell of the full tissue is an image.
  [[nodiscard]] CellId original(CellId of_whole) const {
    return is_used() ? origins[cells[of_whole.index()].index()] : of_whole;
  }
  /// Return vectors (positions, or others that mirror likewise) of all nodes of the full tissue from those of a side.
  [[nodiscard]] Vectors full_vectors(std::span<const Vec3> of_side) const;
};

/// View of vectors of a side, read by nodes of the full tissue.
struct MirroredVectors {
  const Mirror& mirror;
  std::span<const Vec3> of_side;
  [[nodiscard]] Vec3 operator[](std::size_t of_whole) const {
    const auto [node, signs] = mirror.image(NodeId(of_whole));
    return signs.cwiseProduct(of_side[node.index()]);
  }
};

/// Asymmetry about a plane; the text names the plane and the problem.
struct NotSymmetric : std::runtime_error {
  NotSymmetric(const std::string& problem, std::string what_would_be_right)
      : std::runtime_error(problem), remedy(std::move(what_would_be_right)) {}
  std::string remedy;
};

/// One side of a symmetric tissue, with its mapping.
struct MirroredSide {
  Tissue tissue;
  Mirror mirror;
};

/// Return the side of a tissue that is positive with respect to the planes across some axes (0, 1, 2 for x, y, z),
/// through the origin. NotSymmetric if a node or cell has no image, a plane cuts a cell, or the sheet is periodic.
MirroredSide side_of(const Tissue& whole, const std::array<bool, 3>& axes);

}  // namespace plica
