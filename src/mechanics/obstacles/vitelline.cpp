#include "mechanics/obstacles/vitelline.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

Capsule enclosing_capsule(const Vectors& positions) {
  Capsule capsule;
  for (const Vec3& p : positions) capsule.radius_um = std::max(capsule.radius_um, std::hypot(p.y(), p.z()));
  // At its height over the axis a node may lie this far out in x.
  for (const Vec3& p : positions) {
    const double reach =
        std::sqrt(std::max(0.0, capsule.radius_um * capsule.radius_um - p.y() * p.y() - p.z() * p.z()));
    capsule.half_axis_um = std::max(capsule.half_axis_um, std::abs(p.x()) - reach);
  }
  return capsule;
}

Vitelline::Vitelline(const Tissue& tissue, const OuterShape& shell) : shell_(shell) {
  for (const Facet& facet : tissue.apical_facets) nodes_.insert(nodes_.end(), facet.nodes.begin(), facet.nodes.end());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  std::erase_if(nodes_, [&](NodeId node) { return node.index() >= tissue.free_node_count(); });
}

}  // namespace plica
