#include "mechanics/obstacle.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "mechanics/model.hpp"

namespace plica {

ObstacleContacts::ObstacleContacts(const Model& model) {
  for (const auto& obstacle : model.obstacles)
    for (const NodeId node : obstacle->nodes()) {
      nodes_.push_back(node);
      obstacles_.push_back(obstacle.get());
    }
  last_.resize(nodes_.size());
  by_node_.resize(nodes_.size());
  std::iota(by_node_.begin(), by_node_.end(), std::size_t{0});
  std::ranges::stable_sort(by_node_, {}, [&](std::size_t contact) { return nodes_[contact]; });
  place_.resize(nodes_.size());
  for (std::size_t k = 0; k < by_node_.size(); ++k) {
    if (k == 0 || nodes_[by_node_[k]] != nodes_[by_node_[k - 1]]) starts_.push_back(k);
    place_[by_node_[k]] = starts_.size() - 1;
  }
  starts_.push_back(by_node_.size());
}

Obstacle::Gap ObstacleContacts::gap(std::size_t contact, std::span<const Vec3> positions) const {
  const Vec3& position = positions[nodes_[contact].index()];
  std::optional<CachedGap>& last = last_[contact];
  // Bitwise comparison, so that earlier queries have no effect (0 and -0 are equal).
  if (!last || std::memcmp(last->position.data(), position.data(), sizeof(Vec3)) != 0)
    last = {position, obstacles_[contact]->gap(position)};
  return last->gap;
}

}  // namespace plica
