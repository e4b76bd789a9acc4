#include "study/reproduce_mechanism.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/units.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

std::unique_ptr<Model> model_of(const std::string& name, const std::vector<std::string>& overrides) {
  return make_model(load_scenario(find_scenario(name), overrides));
}

// The springs' inward force on each apical node over the area around it, Pa, averaged over the nodes of each cell of
// the ventral midline; by the place of the cell. All springs are on.
Curve inward_force(const std::string& name, const Model& model, const FurrowSites& sites) {
  const Tissue& tissue = model.tissue;
  const Vectors& rest = tissue.rest_positions;
  Vectors forces(rest.size(), Vec3::Zero()), normals(rest.size(), Vec3::Zero());
  const Step still{rest, rest, forces, 1, 1e6};
  Vectors sum(rest.size(), Vec3::Zero());
  for (const Contraction* contraction : model.contractions) contraction->add_forces(still, sum);
  for (const Facet& facet : tissue.apical_facets) {
    const Vec3 area = facet_area_vector(gather(std::span<const Vec3>(rest), facet));
    for (const NodeId node : facet.nodes) normals[node.index()] += area / 4;
  }
  Curve curve{name, {}, {}, true};
  for (const CellId id : sites.midline) {
    const Cell& cell = tissue.cells[id.index()];
    double pressure = 0;
    for (int i = 4; i < 8; ++i) {
      const Vec3& normal = normals[cell.corners[i].index()];
      pressure -= sum[cell.corners[i].index()].dot(normal) / normal.squaredNorm() / 4;
    }
    curve.x.push_back(cell_centre(cell, rest).x());
    curve.y.push_back(pressure / units::pascal);
  }
  return curve;
}

Curve inward_force(const std::string& name, const std::string& scenario, const std::vector<std::string>& overrides) {
  const Scenario loaded = load_scenario(find_scenario(scenario), overrides);
  const auto model = make_model(loaded);
  return inward_force(name, *model, make_furrow_sites(loaded, model->tissue));
}

// Mean over the places with low <= |x| <= high.
double mean_between(const Curve& curve, double low, double high) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (std::abs(curve.x[i]) >= low && std::abs(curve.x[i]) <= high) sum += curve.y[i], ++count;
  return count > 0 ? sum / count : 0;
}

struct Extent {
  Vec3 low = Vec3::Constant(1e300), high = Vec3::Constant(-1e300);
  void take(const Vec3& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
};

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
  // The pill's cylinder ends at 90 um; the last ventral cells' edges, where rows from three sides meet, are left out.
  result.figures["laplace.pill_ratio"] = mean_between(pill, 110, 190) / mean_between(pill, 0, 50);
  result.figures["laplace.sphere_ratio"] = mean_between(sphere, 50, 100) / mean_between(sphere, 0, 30);
  const auto middle_over_end = [](const Curve& curve) {  // VCE: the second-last of 14 cells, 128 um from the middle
    double largest = 0;
    for (const double value : curve.y) largest = std::max(largest, value);
    return mean_between(curve, 0, 15) / largest;
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
    Extent extent;
    for (const Vec3& point : tissue.rest_positions) extent.take(point);
    figures[prefix + "_length_um"] = (extent.high - extent.low).x();
    figures[prefix + "_width_um"] = (extent.high - extent.low).y();
    const std::vector<double> volumes = model->volumes.volumes(tissue.rest_positions);
    double volume = 0;
    for (const double one : volumes) volume += one;
    figures[prefix + "_cell_volume_um3"] = volume / static_cast<double>(volumes.size());
    if (prefix != "mesh.pill") continue;

    double product = 0;
    const auto gradients = model->volumes.element_gradients(tissue.rest_positions);
    for (std::size_t e = 0; e < gradients.size(); ++e)
      for (int i = 0; i < 8; ++i)
        product += gradients[e][i].dot(tissue.rest_positions[model->volumes.elements()[e][i].index()]);
    figures["mesh.gradient_sum"] = product / volume;
    Extent strip;
    for (const Facet& facet : tissue.apical_facets)
      if (tissue.regions.at("furrow")[facet.cell.index()])
        for (const NodeId node : facet.nodes) strip.take(tissue.rest_positions[node.index()]);
    figures["mesh.strip_percent"] = 100 * (strip.high - strip.low).x() / figures["mesh.pill_length_um"];
  }
  const auto three_rows = model_of("drosophila", {"region.furrow.cells_across=3"});
  const std::vector<double> areas = rest_apical_areas(three_rows->tissue);
  for (std::size_t c = 0; c < areas.size(); ++c)
    if (three_rows->tissue.regions.at("furrow")[c]) figures["mesh.three_rows_area_um2"] += areas[c];
  return figures;
}

}  // namespace plica
