// Laplace's law, by pressures that are solved for: a ball of cells with a tense cortex on either side, filled with
// yolk. A surface of tension T and radius R holds a pressure that is larger inside by 2T/R. Cells are larger in
// pressure than what is outside by that of the apical cortex, the yolk than cells by that of the basal one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "measure/cells.hpp"
#include "mechanics/active/cortex.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/surroundings.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

struct Pressures {
  double cells, yolk;  // over those of Laplace's law
};

Pressures pressures(int cells, double apical_tension, double basal_tension) {
  Model model(build_shell({200, 200, 20, {cells, cells, cells}, {1, 1, 1}}));
  const Tissue& tissue = model.tissue;
  model.stiffness_scale = 1e-4;
  model.laws.push_back(std::make_unique<Corotational>(tissue, ElasticModuli::from_young(1e-4, 0), 0));
  model.laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-3));
  const CellSet all(tissue.cells.size(), true);
  for (const auto& [side, tension] : {std::pair(CellSide::apical, apical_tension), {CellSide::basal, basal_tension}})
    if (tension > 0)
      model.laws.push_back(std::make_unique<Cortex>(tissue, all, CortexRule{.side = side, .tension = tension}));
  model.constraints.push_back(std::make_unique<EnclosedVolume>(tissue));
  NewtonStepper stepper(model);
  State state = rest_state(model);
  for (int step = 0; step < 12; ++step) {
    State next;
    EXPECT_TRUE(stepper.advance(state, 2, step == 0, next).converged());
    state = std::move(next);
  }
  double of_cells = 0;
  for (const double pressure : state.pressures(model)) of_cells += pressure / static_cast<double>(tissue.cells.size());
  const auto radius = [](double volume) { return std::cbrt(0.75 * volume / std::numbers::pi); };
  const double outer = 2 * apical_tension / radius(*volume_inside_apices(tissue, state.positions)),
               inner = 2 * basal_tension / radius(*lumen_volume(tissue, state.positions));
  return {of_cells / outer, state.multipliers.back() / (outer + inner)};
}

TEST(CortexSphere, PressureJumpsByLaplacesLaw) {
  double last = 1;
  for (const int cells : {6, 12}) {
    const Pressures found = pressures(cells, 1, 0.4);
    std::printf("sphere of %d cells: pressure of cells %.4f, of the yolk %.4f of Laplace's\n", 6 * cells * cells,
                found.cells, found.yolk);
    EXPECT_LT(std::abs(found.yolk - 1), last);
    last = std::abs(found.yolk - 1);
    if (cells < 12) continue;
    EXPECT_NEAR(found.cells, 1, 0.01);
    EXPECT_NEAR(found.yolk, 1, 0.01);
  }
}

}  // namespace
}  // namespace plica
