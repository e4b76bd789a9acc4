#include "mechanics/cell_stress.hpp"

#include "core/units.hpp"
#include "measure/monitor.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/energy.hpp"
#include "simulation/simulation.hpp"
#include "support/cortices.hpp"
#include "support/law_checks.hpp"
#include "support/scenarios.hpp"

namespace {

const BlockShape six{.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}};

// A cortex without active tension.
CortexRule passive_cortex(CellSide side) {
  CortexRule rule = whole_cortex(side);
  rule.tension = 0;
  return rule;
}

// Integrals of stress over all cells are the virial of the forces, -sum f x^T: what a strain of the whole body changes.
void expect_virial(const Law& law, const Tissue& tissue) {
  Motion motion = random_motion(tissue, 2, 5);
  motion.internal = law.first_internal(tissue);
  motion.internal = law.next_internal(motion.step());
  motion.previous_positions = motion.positions;
  motion.rate_s = no_time_s;
  Step step = motion.step();
  step.ahead = 0;
  std::vector<Mat3> of_cells(tissue.cells.size(), Mat3::Zero());
  law.add_stress_integrals(step, of_cells);
  Vectors forces(tissue.node_count(), Vec3::Zero());
  law.add_forces(step, forces);
  Mat3 sum = Mat3::Zero();
  for (const Mat3& of_cell : of_cells) {
    EXPECT_GT(of_cell.norm(), 0);
    EXPECT_LT((of_cell - of_cell.transpose()).norm(), 1e-9 * of_cell.norm());
    sum += of_cell;
  }
  for (std::size_t n = 0; n < forces.size(); ++n) sum += forces[n] * step.positions[n].transpose();
  EXPECT_LT(sum.norm(), 1e-9 * of_cells[0].norm());
}

TEST(CellStress, IntegralsAreTheVirialOfForces) {
  const Tissue tissue = distorted_block(six, 2, 3);
  expect_virial(NeoHookean(tissue, std::vector(tissue.elements.size(), NeoHookeanMaterial{0.3, 2})), tissue);
  expect_virial(Corotational(tissue, std::vector(tissue.elements.size(), ElasticModuli::from_young(1, 0.3)), 0.5),
                tissue);
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    SCOPED_TRACE(static_cast<int>(side));
    expect_virial(Cortex(tissue, CellSet(6, true), passive_cortex(side)), tissue);
  }
}

// Six cells of shear modulus 0.3 kPa with apical cortices of stiffness 2 nN/um, stretched by a quarter along x.
struct Stretched {
  static constexpr double stretch = 1.25;

  explicit Stretched(const ShapeActivationRule& rule = {}) : model(build_block(six)) {
    const Tissue& tissue = model.tissue;
    model.laws.push_back(
        std::make_unique<NeoHookean>(tissue, std::vector(tissue.elements.size(), NeoHookeanMaterial{0.3, 0})));
    model.laws.push_back(std::make_unique<Cortex>(tissue, CellSet(6, true),
                                                  CortexRule{.tension = 1, .stiffness = 2, .activation = rule}));
    state = rest_state(model);
    state.time_s = 30;
    state.positions =
        deformed(tissue, Vec3(stretch, 1 / std::sqrt(stretch), 1 / std::sqrt(stretch)).asDiagonal()).positions;
    follow_signals(model, state);
  }
  /// Expected stress, kPa: mu/2 (s^2 - 1/s), and the tension of the cortex over the height.
  [[nodiscard]] static double stress() {
    return 0.15 * (stretch * stretch - 1 / stretch) + 2 * (std::sqrt(stretch) - 1) * std::sqrt(stretch) / 30;
  }
  [[nodiscard]] double activity(std::size_t cell) const {
    return *model.laws[1]->activity_of(CellId(cell), state.time_s, state.internals[1]);
  }

  Model model;
  State state;
};

TEST(CellStress, OfAStretchedSheetIsThatOfItsMatterAndItsCortex) {
  const Stretched sheet;
  for (const double stress : passive_stresses(sheet.model, sheet.state))
    EXPECT_NEAR(stress, Stretched::stress(), 1e-12);
}

TEST(CellStress, ActivitiesReadIt) {
  using Kind = ShapeActivationRule::Kind;
  const double stress = Stretched::stress();
  ShapeActivationRule rule{.kind = Kind::follows, .measure = ShapeMeasure::passive_stress, .from = 0, .to = 4 * stress};
  rule.signal = 0;
  for (const bool of_neighbours : {false, true}) {
    rule.of_neighbours = of_neighbours;
    EXPECT_NEAR(Stretched(rule).activity(2), 0.25, 1e-12);
  }
  rule.kind = Kind::starts_above;
  for (const auto& [threshold, started] : {std::pair(0.9 * stress, true), {1.1 * stress, false}}) {
    rule.threshold = threshold;
    EXPECT_EQ(Stretched(rule).activity(2), started ? 1 : 0) << threshold;
  }
  rule.kind = Kind::follows;
  EXPECT_SAYS(error_of<NoGradient>([&] { return &Stretched(rule).model.laws[1]->derivatives(); }),
              "activity by stress has no derivative");
}

// Without loads, the mean stress of a body is 0: matter resists what cortices pull, -2 gamma/h here.
TEST(CellStress, OfOneCellBalancesItsActiveTension) {
  const std::string cell =
      "format = 1\n[embryo]\nshape = \"block\"\nlength_um = 20\nwidth_um = 20\ncell_height_um = 20\ncells = [1, 1, 1]\n"
      "[cortex.apical]\nregion = \"all\"\ntension_mN_per_m = 2\n"
      "[cortex.basal]\nregion = \"all\"\nfaces = \"basal\"\ntension_mN_per_m = 2\n";
  Monitor monitor;
  monitor.quantity = quantity_named("stress");
  for (const char* elastic : {"corotational", "neo-hookean"}) {
    SCOPED_TRACE(elastic);
    Simulation simulation(scenario_of(cell, {fmt::format("elasticity.model={}", elastic)}));
    simulation.run();
    const Model& model = simulation.model();
    const State& state = simulation.state();
    const double area = facet_area(gather(state.positions, model.tissue.apical_facets[0]));
    EXPECT_LT(area, 350);
    EXPECT_NEAR(*read_monitor(monitor, {model, state}).number,
                -4 * area / model.volumes.volumes(state.positions)[0] / units::pascal, 1);
  }
}

}  // namespace
