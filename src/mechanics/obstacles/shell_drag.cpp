#include "mechanics/obstacles/shell_drag.hpp"

namespace plica {

ShellDrag::ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag) : shell_(tissue, shell), drag_(drag) {
  coefficients_.assign(tissue.node_count(), 0.0);
  for (const Facet& facet : tissue.apical_facets)
    for (const NodeId node : facet.nodes)
      coefficients_[node.index()] += drag_ * facet_area(rest_corners(tissue, facet)) / 4;
}

}  // namespace plica
