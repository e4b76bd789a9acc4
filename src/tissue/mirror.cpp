#include "tissue/mirror.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/box_grid.hpp"
#include "tissue/mesher.hpp"

namespace plica {
namespace {

constexpr std::array<char, 3> axis_names = {'x', 'y', 'z'};

double largest_coordinate(const Tissue& tissue) {
  double largest = 0;
  for (const Vec3& x : tissue.rest_positions) largest = std::max(largest, x.cwiseAbs().maxCoeff());
  return largest;
}

/// The images of all nodes and cells in the plane across one axis.
struct Images {
  std::vector<NodeId> nodes;
  std::vector<CellId> cells;
};

class Reflecting {
 public:
  explicit Reflecting(const Tissue& whole)
      : whole_(whole),
        extent_(largest_coordinate(whole)),
        // Rounding of a mesh in double precision, with a margin.
        tolerance_(1e-9 * extent_),
        nodes_(1e-3 * extent_, boxes_at(whole.rest_positions)) {
    for (std::size_t e = 0; e < whole.elements.size(); ++e) of_nodes_[sorted(whole.elements[e])] = ElementId(e);
  }

  [[nodiscard]] double tolerance() const { return tolerance_; }

  [[nodiscard]] Images in(int axis) const {
    const std::string plane = fmt::format("the plane {} = 0", axis_names[axis]);
    refuse_cut_cells(axis, plane);
    Images images;
    for (const Vec3& x : whole_.rest_positions) {
      Vec3 beyond = x;
      beyond[axis] = -x[axis];
      const std::optional<NodeId> image = node_at(beyond);
      if (!image)
        throw NotSymmetric(fmt::format("the mesh is not symmetric about {}: it has a node at {:.6g}, {:.6g}, {:.6g} um "
                                       "but none at its image",
                                       plane, x.x(), x.y(), x.z()),
                           "center the mesh at 0, or remove embryo.mirror");
      images.nodes.push_back(*image);
    }
    images.cells.resize(whole_.cells.size());
    for (std::size_t e = 0; e < whole_.elements.size(); ++e) {
      auto nodes = whole_.elements[e];
      for (NodeId& node : nodes) node = images.nodes[node.index()];
      const CellId cell = whole_.element_cell[e];
      const auto found = of_nodes_.find(sorted(nodes));
      CellId& image = images.cells[cell.index()];
      const CellId now = found == of_nodes_.end() ? CellId() : whole_.element_cell[found->second.index()];
      if (!now.valid() || (image.valid() && image != now))
        throw NotSymmetric(
            fmt::format("the mesh is not symmetric about {}: cell {} has no image", plane, cell.number()),
            "use a symmetric mesh, or remove embryo.mirror");
      image = now;
    }
    return images;
  }

 private:
  [[nodiscard]] static std::vector<Box> boxes_at(std::span<const Vec3> places) {
    std::vector<Box> boxes;
    for (const Vec3& place : places) boxes.push_back({place, place});
    return boxes;
  }
  [[nodiscard]] static std::array<NodeId, 8> sorted(std::array<NodeId, 8> nodes) {
    std::ranges::sort(nodes);
    return nodes;
  }
  [[nodiscard]] std::optional<NodeId> node_at(const Vec3& place) const {
    std::vector<std::uint32_t> near;
    nodes_.find_overlapping(Box{place, place}.widened(tolerance_), near);
    return near.empty() ? std::nullopt : std::optional(NodeId(std::size_t{near.front()}));
  }
  void refuse_cut_cells(int axis, const std::string& plane) const {
    for (std::size_t c = 0; c < whole_.cells.size(); ++c) {
      bool below = false, above = false;
      for (const NodeId node : whole_.cells[c].corners) {
        below = below || whole_.rest_positions[node.index()][axis] < -tolerance_;
        above = above || whole_.rest_positions[node.index()][axis] > tolerance_;
      }
      if (below && above)
        throw NotSymmetric(fmt::format("{} cuts cells in two, for example cell {}", plane, c),
                           fmt::format("give an even number of cells along {}", axis_names[axis]));
    }
  }

  const Tissue& whole_;
  double extent_, tolerance_;
  BoxGrid nodes_;
  std::map<std::array<NodeId, 8>, ElementId> of_nodes_;
};

}  // namespace

namespace {

/// Return the identity, and all products of reflections in planes with these images of nodes by axis.
std::vector<Mirror::Reflection> reflections_of(std::size_t nodes, const std::array<std::vector<NodeId>, 3>& images) {
  std::vector<Mirror::Reflection> all = {{Vec3::Ones(), {}}};
  for (std::size_t n = 0; n < nodes; ++n) all.front().nodes.emplace_back(n);
  for (int axis = 0; axis < 3; ++axis) {
    if (images[axis].empty()) continue;
    for (std::size_t i = 0, known = all.size(); i < known; ++i) {
      Mirror::Reflection further = all[i];
      further.signs[axis] = -1;
      for (NodeId& node : further.nodes) node = images[axis][node.index()];
      all.push_back(std::move(further));
    }
  }
  return all;
}

}  // namespace

TissueChange keep_only(Tissue& tissue, const CellSet& cells) {
  TissueChange change = no_change(tissue);
  std::erase_if(change.origin, [&](CellId cell) { return !cells[cell.index()]; });
  tissue.sheet.keep(change.origin);
  keep_elements(tissue, change.origin);
  follow(change, tissue);
  return change;
}

Vectors Mirror::full_vectors(std::span<const Vec3> of_side) const {
  const MirroredVectors mirrored{*this, of_side};
  Vectors all(is_used() ? nodes.size() : of_side.size());
  for (std::size_t n = 0; n < all.size(); ++n) all[n] = mirrored[n];
  return all;
}

MirroredSide side_of(const Tissue& whole, const std::array<bool, 3>& axes) {
  if (whole.is_periodic())
    throw NotSymmetric("a periodic sheet cannot be reduced to one side", "remove it, or embryo.periodic");
  const Reflecting reflecting(whole);
  MirroredSide side{whole, {}};
  Mirror& mirror = side.mirror;
  for (std::size_t n = 0; n < whole.node_count(); ++n) mirror.nodes.push_back({NodeId(n), Vec3::Ones()});
  for (std::size_t c = 0; c < whole.cells.size(); ++c) mirror.cells.emplace_back(c);
  CellSet is_own(whole.cells.size(), true);
  std::array<std::vector<NodeId>, 3> images_of_nodes;
  for (int axis = 0; axis < 3; ++axis) {
    if (!axes[axis]) continue;
    const Images images = reflecting.in(axis);
    const auto is_beyond = [&](NodeId node) {
      return whole.rest_positions[node.index()][axis] < -reflecting.tolerance();
    };
    for (auto& [node, signs] : mirror.nodes)
      if (is_beyond(node)) {
        node = images.nodes[node.index()];
        signs[axis] = -1;
      }
    for (std::size_t c = 0; c < whole.cells.size(); ++c)
      if (std::ranges::any_of(whole.cells[c].corners, is_beyond)) is_own[c] = false;
    for (CellId& cell : mirror.cells)
      if (std::ranges::any_of(whole.cells[cell.index()].corners, is_beyond)) cell = images.cells[cell.index()];
    images_of_nodes[axis] = images.nodes;
  }
  mirror.reflections = reflections_of(whole.node_count(), images_of_nodes);

  mirror.origins = keep_only(side.tissue, is_own).origin;
  const std::vector<NodeId> node_origins = drop_unused_nodes(side.tissue);
  std::vector<NodeId> node_now(whole.node_count());
  for (std::size_t n = 0; n < node_origins.size(); ++n) node_now[node_origins[n].index()] = NodeId(n);
  for (auto& [node, signs] : mirror.nodes) node = node_now[node.index()];
  std::vector<CellId> cell_now(whole.cells.size());
  for (std::size_t c = 0; c < mirror.origins.size(); ++c) cell_now[mirror.origins[c].index()] = CellId(c);
  for (CellId& cell : mirror.cells) cell = cell_now[cell.index()];

  side.tissue.is_mirrored = axes;
  for (Vec3& x : side.tissue.rest_positions)
    for (int axis = 0; axis < 3; ++axis)
      if (axes[axis] && std::abs(x[axis]) <= reflecting.tolerance()) x[axis] = 0;
  return side;
}

}  // namespace plica
