#include "paper/mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/units.hpp"
#include "measure/cells.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

// The pill's cylinder ends at 90 um; cells that lie on both sides of that are left out.
constexpr double cylinder_to_um = 70, cap_from_um = 110;

std::unique_ptr<Model> model_of(const std::string& name, const std::vector<std::string>& overrides) {
  return make_model(load_scenario(find_scenario(name), overrides));
}

// The springs' inward force on each apical node over the area around it, Pa, averaged over the nodes of each cell of
// the ventral midline; by the place of the cell. All springs are on.
Curve inward_force(const std::string& name, const std::string& scenario_name,
                   const std::vector<std::string>& overrides) {
  const Scenario scenario = load_scenario(find_scenario(scenario_name), overrides);
  const auto model = make_model(scenario);
  const Tissue& tissue = model->tissue;
  const Vectors& rest = tissue.rest_positions;
  State switched_on = rest_state(*model);
  switched_on.time_s = 1e6;
  const Vectors forces = active_forces(*model, switched_on);
  Vectors normals(rest.size(), Vec3::Zero());
  for (const Facet& facet : tissue.apical_facets) {
    const Vec3 area = facet_area_vector(gather(std::span<const Vec3>(rest), facet));
    for (const NodeId node : facet.nodes) normals[node.index()] += area / 4;
  }
  Curve curve{name, {}, {}, true};
  for (const CellId id : make_furrow_sites(scenario, tissue).midline) {
    const Cell& cell = tissue.cells[id.index()];
    double pressure = 0;
    for (const NodeId corner : cell.apical_corners()) {
      const Vec3& normal = normals[corner.index()];
      pressure -= forces[corner.index()].dot(normal) / normal.squaredNorm() / static_cast<double>(cell.sides());
    }
    curve.x.push_back(cell_centre(cell, rest).x());
    curve.y.push_back(pressure / units::pascal);
  }
  return curve;
}

// Hoop and mean tension of a network of equal springs at each midline cell, over that of square cells: a spring of zero
// rest length carries k l, and stands for a width w; so T = 2 k l / w, more along the longer side of the cell.
struct NetworkTension {
  std::vector<double> hoop, mean;
};

NetworkTension network_tension(const Tissue& tissue, const FurrowSites& sites) {
  NetworkTension tension;
  for (const CellId id : sites.midline) {
    double along = 0, across = 0;
    for (const CellEdge& edge : tissue.cells[id.index()].edges) {
      if (edge.side != CellSide::apical) continue;
      const double length =
          (tissue.rest_positions[edge.nodes.back().index()] - tissue.rest_positions[edge.nodes.front().index()]).norm();
      (edge.direction == EdgeDirection::along ? along : across) += length;
    }
    tension.hoop.push_back(across / along);
    tension.mean.push_back((across / along + along / across) / 2);
  }
  return tension;
}

// Mean over the places with low <= |x| <= high.
double mean_between(const Curve& curve, double low, double high) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::abs(curve.x[i]) >= low && std::abs(curve.x[i]) <= high) sum += curve.y[i], ++count;
  return count > 0 ? sum / count : 0;
}

// Inward force over the tension that causes it, on the caps (both directions) over on the cylinder (the hoop): 2 by
// Laplace's law, 1/R + 1/R against 1/R.
double cap_over_cylinder(const Curve& force) {
  const Scenario scenario = load_scenario(find_scenario("drosophila"));
  const Tissue tissue = make_tissue(scenario);
  const NetworkTension tension = network_tension(tissue, make_furrow_sites(scenario, tissue));
  Curve over_hoop = force, over_mean = force;
  for (std::size_t i = 0; i < force.y.size(); ++i) over_hoop.y[i] /= tension.hoop[i], over_mean.y[i] /= tension.mean[i];
  return mean_between(over_mean, cap_from_um, 1e3) / mean_between(over_hoop, 0, cylinder_to_um);
}

}  // namespace

Mechanism mechanism() {
  const std::vector<std::string> everywhere = {"contraction.apical.region=all", "contraction.apical.across_ratio=1",
                                               "furrow.region=furrow"};
  const Curve pill = inward_force("pill, equal springs on every cell", "drosophila", everywhere);
  const Curve sphere = inward_force("sphere, equal springs on every cell", "xenopus", everywhere);
  const Curve chosen = inward_force("pill, chosen reading (5 rows, across 0.35)", "drosophila", {});
  const Curve axial =
      inward_force("pill, 5 rows, springs along the axis only", "drosophila", {"contraction.apical.across_ratio=0"});

  Mechanism result;
  result.figures["laplace.pill_ratio"] = mean_between(pill, cap_from_um, 1e3) / mean_between(pill, 0, cylinder_to_um);
  result.figures["laplace.pill_ratio_of_tension"] = cap_over_cylinder(pill);
  result.figures["laplace.sphere_ratio"] = mean_between(sphere, 50, 100) / mean_between(sphere, 0, 30);
  const auto middle_over_end = [](const Curve& curve) {
    return mean_between(curve, 0, 15) / *std::ranges::max_element(curve.y);
  };
  result.figures["laplace.chosen_middle_over_end"] = middle_over_end(chosen);
  result.figures["laplace.axial_middle_over_end"] = middle_over_end(axial);
  result.plot = {"Springs' inward force per apical area along the ventral midline, t = 0",
                 {"place along the axis at rest, um"},
                 {"inward force per area, Pa"},
                 {pill, sphere, chosen, axial},
                 {{"cylinder ends", 90, {}}, {"", -90, {}}},
                 {}};
  return result;
}

Figures mesh_figures() {
  Figures figures;
  for (const auto& [name, scenario] : {std::pair{"pill", "drosophila"}, {"sphere", "xenopus"}}) {
    const auto model = model_of(scenario, {});
    const Tissue& tissue = model->tissue;
    const std::string prefix = std::string("mesh.") + name;
    figures[prefix + "_cells"] = static_cast<double>(tissue.cells.size());
    figures[prefix + "_nodes"] = static_cast<double>(tissue.node_count());
    Eigen::AlignedBox3d extent;
    for (const Vec3& point : tissue.rest_positions) extent.extend(point);
    figures[prefix + "_length_um"] = extent.sizes().x();
    figures[prefix + "_width_um"] = extent.sizes().y();
    const std::vector<double> volumes = model->volumes().volumes(tissue.rest_positions);
    double volume = 0;
    for (const double one : volumes) volume += one;
    figures[prefix + "_cell_volume_um3"] = volume / static_cast<double>(volumes.size());
    if (prefix != "mesh.pill") continue;

    double product = 0;
    Vectors gradient(tissue.node_count(), Vec3::Zero());  // of all cells' volume
    const std::vector<double> ones(volumes.size(), 1.0);
    model->volumes().add_forces(tissue.rest_positions, ones, gradient);
    for (std::size_t n = 0; n < gradient.size(); ++n) product += gradient[n].dot(tissue.rest_positions[n]);
    figures["mesh.gradient_sum"] = product / volume;
    Eigen::AlignedBox3d strip;
    for (const Facet& facet : tissue.apical_facets)
      if (tissue.regions.at("furrow")[facet.cell.index()])
        for (const NodeId node : facet.nodes) strip.extend(tissue.rest_positions[node.index()]);
    figures["mesh.strip_percent"] = 100 * strip.sizes().x() / figures["mesh.pill_length_um"];
  }
  const auto three_rows = model_of("drosophila", {"region.furrow.cells_across=3"});
  const std::vector<double> areas = rest_apical_areas(three_rows->tissue);
  for (std::size_t c = 0; c < areas.size(); ++c)
    if (three_rows->tissue.regions.at("furrow")[c]) figures["mesh.three_rows_area_um2"] += areas[c];
  return figures;
}

}  // namespace plica
