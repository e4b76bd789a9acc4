#include "simulation/crossing_warning.hpp"

#include <fmt/format.h>

#include "core/units.hpp"
#include "measure/self_intersections.hpp"

namespace plica {

std::string crossing_warning(const Scenario& scenario, const Simulation& simulation) {
  const Tissue& tissue = simulation.model().tissue;
  const Vectors& positions = simulation.state().positions;
  for (const auto& [side, facets] : {std::pair("apical", &tissue.apical_facets), {"basal", &tissue.basal_facets}}) {
    const auto pairs = crossing_facets(*facets, positions);
    if (pairs.empty()) continue;
    const Facet &one = (*facets)[pairs.front().first], &other = (*facets)[pairs.front().second];
    Vec3 place = Vec3::Zero();
    for (const NodeId node : one.nodes) place += positions[node.index()] / 4;
    const auto id = [&](const Facet& facet) { return tissue.cells[facet.cell.index()].lineage.id; };
    return fmt::format(
        "the tissue self-intersects: at t = {:.4g} min {} faces of cells {} and {} cross at x = {:.1f}, y = {:.1f}, "
        "z = {:.1f} um ({} pairs in all); later results are unphysical{}",
        simulation.time_s() / units::minute, side, id(one), id(other), place.x(), place.y(), place.z(), pairs.size(),
        crossing_remedy(scenario));
  }
  return "";
}

std::string crossing_remedy(const Scenario& scenario) {
  // The rim of an open tissue is no contact surface.
  return scenario.self_contact.surface == "both"
             ? ""
             : "; set self_contact.surface to \"both\" to prevent it (except at the rim of an open tissue)";
}

}  // namespace plica
