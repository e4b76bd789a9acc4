// Fixed directions of nodes: held ones, and normals of touched obstacles.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "solver/linear/iterate.hpp"

namespace plica {

/// Frame of a node; the first `fixed` columns of `axes`, orthonormal, are its fixed directions.
struct NodeFrame {
  Mat3 axes = Mat3::Identity();
  int fixed = 0;
  bool operator==(const NodeFrame&) const = default;
  [[nodiscard]] Vec3 free_part(Vec3 vector) const {
    for (int i = 0; i < fixed; ++i) vector -= axes.col(i).dot(vector) * axes.col(i);
    return vector;
  }
};

/// Return the frames of free nodes: held axes first, then normals.
std::vector<NodeFrame> node_frames(const Model& model, const ObstacleContacts& contacts, const Iterate& at);

/// Return `direction` without components along held axes.
Vec3 without_held(const Model& model, std::size_t node, Vec3 direction);

/// Independent contacts of one node, beyond its held axes and earlier contacts.
struct NodeObstacles {
  int count = 0;
  std::array<std::size_t, 3> contact;
  std::array<Vec3, 3> inward;       // normals of the obstacles, direction of obstacle forces
  std::array<Vec3, 3> free_normal;  // parts of the normals outside held axes; the node moves along them
};
NodeObstacles node_obstacles(const Model& model, const ObstacleContacts& contacts, std::span<const std::size_t> of_node,
                             const Iterate& at);

/// Move nodes in contact back onto their obstacles, along their free normals.
void return_to_obstacles(const Model& model, const ObstacleContacts& contacts, Iterate& at);

}  // namespace plica
