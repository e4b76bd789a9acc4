// The directions in which nodes cannot move: held ones, and the normals of obstacles that they touch.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/linear/iterate.hpp"

namespace plica {

/// The first `fixed` columns of `axes`, orthonormal, are the directions in which a node is fixed.
struct NodeFrame {
  Mat3 axes = Mat3::Identity();
  int fixed = 0;
  bool operator==(const NodeFrame&) const = default;
  [[nodiscard]] Vec3 free_part(Vec3 vector) const {
    for (int i = 0; i < fixed; ++i) vector -= axes.col(i).dot(vector) * axes.col(i);
    return vector;
  }
};

/// Frames of the free nodes: held axes first, then normals.
std::vector<NodeFrame> node_frames(const Model& model, const Contacts& contacts, const Iterate& at);

/// `direction` without the axes along which the node is held.
Vec3 without_held(const Model& model, std::size_t node, Vec3 direction);

/// The contacts that keep one node, as far as its held axes and the contacts before them leave them something to do.
struct NodeContacts {
  int count = 0;
  std::array<std::size_t, 3> contact;
  std::array<Vec3, 3> inward;  // the obstacles' own normals: along them they push
  std::array<Vec3, 3> way;     // what the holds leave of these: along them the node can go
};
NodeContacts node_contacts(const Model& model, const Contacts& contacts, std::span<const std::size_t> of_node,
                           const Iterate& at);

/// Puts nodes in contact back on their obstacles, along the normals that they are free to move along.
void return_to_obstacles(const Model& model, const Contacts& contacts, Iterate& at);

}  // namespace plica
