#include "support/models.hpp"

#include "mechanics/obstacles/vitelline.hpp"
#include "support/elements.hpp"

namespace plica::support {

void add_elasticity(Model& model, double poisson) {
  const ElasticModuli moduli = ElasticModuli::from_young(1, poisson);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, in_elements(model.tissue, moduli), 0));
  model.laws.push_back(
      std::make_unique<Dilatation>(model.tissue, in_elements(model.tissue, moduli.bulk_modulus()), false));
}

void add_contraction(Model& model, const CellSet& cells, const ContractionRule& rule, Program program) {
  model.laws.push_back(
      std::make_unique<Contraction>(contraction_springs(model.tissue, cells, rule), std::move(program)));
}

void add_drag(Model& model, double drag) { model.laws.push_back(std::make_unique<SurfaceDrag>(model.tissue, drag)); }

Model dimpling_sheet(std::array<int, 3> elements_per_cell) {
  Model model(build_block({.length_um = 60,
                           .width_um = 60,
                           .cell_height_um = 40,
                           .cells = {3, 3, 1},
                           .elements_per_cell = elements_per_cell}));
  add_elasticity(model);
  CellSet middle(9);
  middle[4] = true;
  add_contraction(model, middle, {.stiffness = 7.3, .across_ratio = 0.4});
  add_drag(model);
  return model;
}

Model furrowing_sphere() {
  Model model(build_shell({.length_um = 280, .cells = {9, 9, 8}}));
  add_elasticity(model);
  CellSet furrow(model.tissue.cells.size());
  for (std::size_t c = 0; c < furrow.size(); ++c) {
    const GridPlace& place = *model.tissue.cells[c].grid_place;
    furrow[c] = place.face == GridPlace::Face::ventral && place.place[0] >= 1 && place.place[0] <= 7 &&
                place.place[1] >= 2 && place.place[1] <= 6;
  }
  add_contraction(model, furrow, {.stiffness = 7.3, .across_ratio = 0.4});
  add_drag(model);
  model.obstacles.push_back(std::make_unique<Vitelline>(model.tissue, *model.tissue.outer_shape));
  return model;
}

Vectors unbalanced_forces(const Model& model, const State& before, const State& after) {
  const Step step{after.positions, before.positions, before.velocities, after.time_s - before.time_s, after.time_s};
  Vectors forces(after.positions.size(), Vec3::Zero());
  for (const auto& law : model.laws) law->add_forces(step, forces);
  if (model.volumes.is_held()) model.volumes.add_forces(after.positions, after.multipliers, forces);
  const ObstacleContacts contacts(model);
  for (std::size_t k = 0; k < contacts.size(); ++k)
    forces[contacts.node(k).index()] += after.obstacle_forces[k] * contacts.gap(k, after.positions).inward;
  return forces;
}

Vectors product_of(const SystemMatrix& matrix, const Vectors& direction) {
  Vectors sum(direction.size(), Vec3::Zero()), of_node(static_cast<std::size_t>(matrix.layout().nodes()));
  for (std::size_t node = 0; node < of_node.size(); ++node) {
    matrix.multiply(node, direction[node], of_node);
    for (std::size_t n = 0; n < of_node.size(); ++n) sum[n] += of_node[n];
  }
  return sum;
}

double force_size(const Model& model, const State& before, const State& after) {
  const Step step{after.positions, before.positions, before.velocities, after.time_s - before.time_s, after.time_s};
  double size = 0;
  for (const auto& law : model.laws) size = std::max(size, largest(forces_of(*law, step)));
  return size;
}

}  // namespace plica::support
