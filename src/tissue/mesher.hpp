// Mesh of a sheet: elements, facets, corners, lines and hanging nodes. The elements of a cell's quadrilateral lie
// between the lines through the stops on its sides; where such a line meets no vertex, its nodes hang.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Point of a polygon on all levels: mean of vertices; weights sum to 1.
using VertexMean = std::vector<std::pair<VertexId, double>>;

/// Outline of a polygon: the stops of each side, with the next corner at 1.
class Outline {
 public:
  explicit Outline(const Polygon& polygon);

  [[nodiscard]] const std::vector<Side>& sides() const { return sides_; }

  /// Add weight times a place to a mean.
  void add(const OutlinePlace& place, double weight, VertexMean& sum) const;

 private:
  const Polygon& polygon_;
  std::vector<Side> sides_;
};

/// Quadrilateral of a polygon: u from its first corner to the second, v from the first to the last. Its sides are parts
/// of the outline, bent at stops, or straight between two places.
class Patch {
 public:
  /// The outline must outlive it.
  Patch(const Outline& outline, const OutlineQuad& corners);

  /// Return the coordinates u (0) or v (1) of element lines: 0, stops on the two sides along it, 1.
  [[nodiscard]] std::vector<double> lines(int along) const;

  /// Return the part of each element, u fastest: its lowest and its highest u and v.
  [[nodiscard]] std::vector<std::array<std::array<double, 2>, 2>> elements() const;

  /// Return a point on the bilinearly blended (Coons) patch of the four sides. It coincides with the sides and is
  /// bilinear between lines through the stops, so elements represent a face exactly. Coordinates are dyadic, so weights
  /// that cancel do so exactly.
  [[nodiscard]] VertexMean point(double u, double v) const;

 private:
  struct Edge {
    std::optional<int> side;  // of the outline
    double from = 0, to = 1;  // there
    std::array<OutlinePlace, 2> ends;
  };
  [[nodiscard]] Edge edge(const OutlinePlace& from, const OutlinePlace& to) const;
  void add_point(const Edge& edge, double at, double weight, VertexMean& sum) const;

  const Outline& outline_;
  std::array<Edge, 4> edges_;
};

/// Return a point of the polygon on one level, as a mean of free nodes in their order.
NodeMean nodes_of(const Sheet& sheet, const VertexMean& mean, std::size_t level);

/// Make the mesh of a tissue from its sheet, rest positions of free nodes, and cells. Hanging nodes are made again.
/// Elements get rest shapes from positions.
void mesh(Tissue& tissue);

/// Make the first mesh of a tissue of which only cells and sheet exist. `place` gives the rest position, um, of a
/// vertex on each level; nodes get numbers as elements come to them, free ones first. `period`: lengths, um, of
/// periods.
void mesh(Tissue& tissue, int layers, const std::function<Vec3(VertexId, int level)>& place, const Vec3& period);

/// Append an element of a cell, with its rest shape, and with facets where its faces are on the surface of the tissue.
void add_element(const std::array<NodeId, 8>& element, CellId id, bool is_basal, bool is_apical, Tissue& tissue);

/// Set the rest shapes of the elements of a cell from that of the cell, after that has changed.
void set_element_rest_shapes(Tissue& tissue, CellId cell);

/// Return the number of elements of a cell in its mesh.
std::size_t element_count(const Sheet& sheet, CellId cell);

/// Keep the elements and facets of these cells only, in their order, where they are the tissue's cells now.
void keep_elements(Tissue& tissue, const std::vector<CellId>& kept);

/// Renumber all nodes: each takes the place of the one `before`. Nodes that are left out must be in no element; free
/// ones come first.
void renumber(Tissue& tissue, const std::vector<NodeId>& before);

/// Renumber all nodes in the order in which elements use them, so that data of nearby elements are close in memory.
void number_as_elements_come(Tissue& tissue);

/// Remove nodes without elements. Return former node numbers: new node to old.
std::vector<NodeId> drop_unused_nodes(Tissue& tissue);

}  // namespace plica
