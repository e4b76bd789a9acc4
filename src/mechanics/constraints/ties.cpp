#include "mechanics/constraints/ties.hpp"

#include <map>

namespace plica {

std::vector<Ties::Tie> ties_along_x(const Tissue& tissue) {
  // By the place in the plane, to a nanometre.
  std::map<std::array<long, 2>, std::vector<NodeId>> lines;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& x = tissue.rest_positions[n];
    lines[{std::lround(1e3 * x.y()), std::lround(1e3 * x.z())}].emplace_back(n);
  }
  std::vector<Ties::Tie> ties;
  for (const auto& [place, nodes] : lines)
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      const std::array tied = {nodes[0], nodes[i]};
      ties.push_back({tied, tissue.rest_positions[nodes[i].index()] - tissue.rest_positions[nodes[0].index()],
                      tissue.side_share(tied)});
    }
  return ties;
}

}  // namespace plica
