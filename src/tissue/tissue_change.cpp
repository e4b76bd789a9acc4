#include "tissue/tissue_change.hpp"

namespace plica {

TissueChange no_change(const Tissue& tissue) {
  TissueChange change;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) change.origin.emplace_back(c);
  for (std::size_t w = 0; w < tissue.sheet.walls.size(); ++w) change.wall_origin.emplace_back(w);
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) change.node_origin.emplace_back(n);
  return change;
}

Vectors with_new_nodes(const Tissue& tissue, const TissueChange& change, const Vectors& before) {
  Vectors after;
  for (const NodeId node : change.node_origin) after.push_back(before[node.index()]);
  for (const NodeMean& place : change.new_nodes) after.push_back(mean_of(place, after));
  after.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging(after);
  return after;
}

}  // namespace plica
