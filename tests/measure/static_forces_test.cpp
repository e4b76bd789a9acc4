// Forces as results show them: of the present state and of what laws remember, on free nodes.
#include <gtest/gtest.h>

#include "measure/cells.hpp"
#include "measure/monitor.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"

namespace plica {
namespace {

using namespace support;

Model model_of(Tissue tissue, double relaxation_s) {
  Model model(std::move(tissue));
  const std::size_t elements = model.tissue.elements.size(), cells = model.tissue.cells.size();
  model.laws.push_back(
      std::make_unique<NeoHookean>(model.tissue, std::vector<NeoHookeanMaterial>(elements, {0.4, relaxation_s})));
  for (const CellSide side : {CellSide::apical, CellSide::lateral})
    model.laws.push_back(std::make_unique<Cortex>(
        model.tissue, CellSet(cells, true),
        CortexRule{
            .side = side, .tension = 0.3, .stiffness = 1, .compression_ratio = 0.5, .relaxation_s = relaxation_s}));
  return model;
}

State stretched(const Model& model, unsigned seed) {
  State state = rest_state(model);
  Random random(seed);
  for (Vec3& x : state.positions) x = Vec3(1.2 * x.x(), 0.9 * x.y(), 1.1 * x.z()) + random.vector(0.5);
  model.tissue.place_hanging(state.positions);
  return state;
}

void expect_equal(const Vectors& a, const Vectors& b, double tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_LE((a[n] - b[n]).norm(), tolerance * largest(b)) << n;
}

Tissue block() {
  return distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 1, 3);
}

void divide_two(Model& model, State& state) {
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 0, 0.5}, {{CellId(4), 1}, 0, 0.5}});
}

// What relaxes within a second has not relaxed yet: its forces are those of what never does.
TEST(StaticForces, OfALawThatRelaxesFastAreThoseOfNow) {
  const Model flowing = model_of(block(), 1), lasting = model_of(block(), 0);
  const State state = stretched(flowing, 5), of_lasting = stretched(lasting, 5);
  for (std::size_t l = 0; l < flowing.laws.size(); ++l)
    expect_equal(forces_of_law(flowing, state, *flowing.laws[l]), forces_of_law(lasting, of_lasting, *lasting.laws[l]),
                 1e-8);
  expect_equal(driving_forces(flowing, state), driving_forces(lasting, of_lasting), 1e-8);
  CellSet some(6, false);
  some[0] = some[1] = some[4] = true;
  expect_equal(forces_of_cells(flowing, state, some), forces_of_cells(lasting, of_lasting, some), 1e-8);
}

// Laws that resist motion show nothing, however stiff.
TEST(StaticForces, OfDragAndViscosityAreNone) {
  Model model(block());
  add_drag(model, 100);
  model.laws.push_back(std::make_unique<Corotational>(
      model.tissue, std::vector<ElasticModuli>(model.tissue.elements.size(), ElasticModuli::from_young(0, 0.3)), 100));
  for (const Vec3& force : driving_forces(model, stretched(model, 7))) EXPECT_EQ(force.norm(), 0);
}

// Nothing is left on hanging nodes, and neither resultant nor torque changes.
TEST(StaticForces, AreOnFreeNodes) {
  Model model = model_of(block(), 1);
  State state = stretched(model, 9);
  divide_two(model, state);
  ASSERT_FALSE(model.tissue.hanging.empty());
  const Vectors no_velocity(state.positions.size(), Vec3::Zero());
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    const Law& law = *model.laws[l];
    const Vectors forces = forces_of_law(model, state, law);
    Vectors as_they_act(forces.size(), Vec3::Zero());
    Step step{state.positions, state.positions, no_velocity, 1e-9, state.time_s};
    step.internal = state.internals[l];
    law.add_forces(step, as_they_act);
    for (std::size_t n = model.tissue.free_node_count(); n < forces.size(); ++n) EXPECT_EQ(forces[n].norm(), 0);
    double size = 0;
    for (const Vec3& force : as_they_act) size += force.norm();
    EXPECT_LE((resultant(forces) - resultant(as_they_act)).norm(), 1e-12 * size) << law.name();
    EXPECT_LE((torque(forces, state.positions) - torque(as_they_act, state.positions)).norm(), 1e-10 * size)
        << law.name();
  }
}

// What two parts of a tissue exert adds up to what the whole does, walls between them included.
TEST(StaticForces, OfPartsAddUp) {
  Model model = model_of(block(), 20);
  State state = stretched(model, 11);
  divide_two(model, state);
  const std::size_t cells = model.tissue.cells.size();
  CellSet left(cells, false), right(cells, false);
  for (std::size_t c = 0; c < cells; ++c) (c % 3 == 0 ? left : right)[c] = true;
  Vectors sum = forces_of_cells(model, state, left);
  const Vectors of_right = forces_of_cells(model, state, right);
  for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += of_right[n];
  expect_equal(sum, forces_of_cells(model, state, CellSet(cells, true)), 1e-12);
  expect_equal(sum, driving_forces(model, state), 1e-12);
}

}  // namespace
}  // namespace plica
