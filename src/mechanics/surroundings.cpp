#include "mechanics/surroundings.hpp"

#include "tissue/tissue_change.hpp"

namespace plica {

SurfaceDrag::SurfaceDrag(const Tissue& tissue, double drag) : drag_(drag) {
  for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets}) add_areas(tissue, *facets, drag);
}

Inertia::Inertia(const Tissue& tissue, double density) : density_(density) {
  coefficients_.resize(tissue.node_count());
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    for (const NodeId node : tissue.elements[e])
      coefficients_[node.index()] += density * hex_volume(tissue.element_rest_shape[e]) / 8;
}

FacePressure::FacePressure(const Tissue& tissue, CellSide side, CellPattern pattern, double pressure, Program program,
                           FollowedSignal followed)
    : SignalLaw(std::move(followed)),
      side_(side),
      pattern_(std::move(pattern)),
      pressure_(pressure),
      program_(std::move(program)) {
  Vectors of_nodes(tissue.node_count(), Vec3::Zero());
  for (const Facet& facet : tissue.facets(side)) {
    if (!pattern_.cells[facet.cell.index()]) continue;
    const double own = pressure * pattern_.strengths[facet.cell.index()];
    const std::size_t first = loads_.size();
    if (followed_.is_used())
      for (const NodeId node : facet.nodes) loads_.push_back({node.index(), facet.cell, Vec3::Zero()});
    // The consistent load of a uniform pressure on a bilinear facet: integral of N_i n dA, 2 x 2 Gauss points.
    const std::array<Vec3, 4> x = gather(tissue.rest_positions, facet);
    const double g = 1 / std::sqrt(3.0);
    for (const double s : {-g, g})
      for (const double t : {-g, g}) {
        const Vec3 by_s = 0.25 * ((1 - t) * (x[1] - x[0]) + (1 + t) * (x[2] - x[3]));
        const Vec3 by_t = 0.25 * ((1 - s) * (x[3] - x[0]) + (1 + s) * (x[2] - x[1]));
        const Vec3 push = -own * by_s.cross(by_t);
        const std::array<double, 4> shape = {(1 - s) * (1 - t) / 4, (1 + s) * (1 - t) / 4, (1 + s) * (1 + t) / 4,
                                             (1 - s) * (1 + t) / 4};
        for (std::size_t i = 0; i < 4; ++i)
          (followed_.is_used() ? loads_[first + i].force : of_nodes[facet.nodes[i].index()]) += shape[i] * push;
      }
  }
  for (std::size_t n = 0; n < of_nodes.size(); ++n)
    if (of_nodes[n] != Vec3::Zero()) loads_.push_back({n, {}, of_nodes[n]});
}

}  // namespace plica
