#include "solver/linear/node_frame.hpp"

#include <Eigen/Dense>

#include "core/parallel.hpp"

namespace plica {
namespace {

constexpr double nothing_left = 1e-6;  // of a normal, by what is fixed already

// Component of a direction orthogonal to the fixed columns from `first` on.
Vec3 beside(const NodeFrame& frame, int first, Vec3 direction) {
  for (int i = first; i < frame.fixed; ++i) direction -= frame.axes.col(i).dot(direction) * frame.axes.col(i);
  return direction;
}

NodeFrame node_frame(const Model& model, std::size_t node, const NodeObstacles& touched) {
  NodeFrame frame;
  for (int axis = 0; axis < 3; ++axis)
    if (model.held[node][axis]) frame.axes.col(frame.fixed++) = Vec3::Unit(axis);
  const int held = frame.fixed;
  for (int k = 0; k < touched.count; ++k)
    frame.axes.col(frame.fixed++) = beside(frame, held, touched.free_normal[k]).normalized();
  if (frame.fixed == 1) frame.axes.col(1) = frame.axes.col(0).unitOrthogonal();
  if (frame.fixed == 1 || frame.fixed == 2) frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  return frame;
}

// One Newton step of the node towards gaps of 0.
void go_to_obstacles(const NodeObstacles& touched, const ObstacleContacts& contacts, std::size_t node,
                     Vectors& positions) {
  Eigen::MatrixXd normals(3, touched.count);
  Eigen::VectorXd gaps(touched.count);
  for (int k = 0; k < touched.count; ++k) {
    normals.col(k) = touched.free_normal[k];
    gaps[k] = contacts.gap(touched.contact[k], positions).value;
  }
  positions[node] -= normals * (normals.transpose() * normals).ldlt().solve(gaps);
}

}  // namespace

Vec3 without_held(const Model& model, std::size_t node, Vec3 direction) {
  for (int axis = 0; axis < 3; ++axis)
    if (model.held[node][axis]) direction[axis] = 0;
  return direction;
}

NodeObstacles node_obstacles(const Model& model, const ObstacleContacts& contacts, std::span<const std::size_t> of_node,
                             const Iterate& at) {
  NodeObstacles touched;
  NodeFrame so_far;
  for (const std::size_t k : of_node) {
    if (!at.on_obstacle[k]) continue;
    const Vec3 inward = contacts.gap(k, at.positions).inward;
    const Vec3 normal = without_held(model, contacts.node(k).index(), inward);
    const Vec3 left = beside(so_far, 0, normal);
    if (touched.count == 3 || left.norm() < nothing_left) continue;
    so_far.axes.col(so_far.fixed++) = left.normalized();
    touched.contact[touched.count] = k;
    touched.inward[touched.count] = inward;
    touched.free_normal[touched.count++] = normal;
  }
  return touched;
}

std::vector<NodeFrame> node_frames(const Model& model, const ObstacleContacts& contacts, const Iterate& at) {
  std::vector<NodeFrame> frames(model.tissue.free_node_count());
  parallel_for(frames.size(), [&](std::size_t n) { frames[n] = node_frame(model, n, {}); });
  parallel_for(contacts.node_count(), [&](std::size_t place) {
    const auto of_node = contacts.at_node(place);
    const NodeObstacles touched = node_obstacles(model, contacts, of_node, at);
    const std::size_t n = contacts.node(of_node.front()).index();
    if (touched.count > 0) frames[n] = node_frame(model, n, touched);
  });
  return frames;
}

void return_to_obstacles(const Model& model, const ObstacleContacts& contacts, Iterate& at) {
  parallel_for(contacts.node_count(), [&](std::size_t place) {
    const auto of_node = contacts.at_node(place);
    const std::size_t n = contacts.node(of_node.front()).index();
    // A node that is partly held does not move along the obstacle normal, so curvature costs several attempts.
    for (int attempt = 0; attempt < 4; ++attempt) {
      const NodeObstacles touched = node_obstacles(model, contacts, of_node, at);
      if (touched.count == 0) return;
      if (touched.count > 1) {
        go_to_obstacles(touched, contacts, n, at.positions);
        continue;
      }
      const Vec3& normal = touched.free_normal[0];
      at.positions[n] -= contacts.gap(touched.contact[0], at.positions).value / normal.squaredNorm() * normal;
      if (normal == touched.inward[0]) return;
    }
  });
  model.tissue.place_hanging_positions(at.positions);
}

}  // namespace plica
