// Random cells of the pill divide in random planes, five rounds, to over 10 000 cells; the tissue relaxes in between.
#include <gtest/gtest.h>

#include "solver/step/newton_stepper.hpp"
#include "support/divided.hpp"
#include "support/loads.hpp"

namespace plica {
namespace {

using namespace support;

// Contraction keeps the sheet moving and bent, so that cuts meet deformed cells.
Model contracting_pill() {
  Model model(build_shell({.length_um = 460, .cells = {18, 9, 8}}));
  add_elasticity(model);
  CellSet furrow(model.tissue.cells.size());
  for (std::size_t c = 0; c < furrow.size(); ++c)
    furrow[c] = model.tissue.cells[c].grid_place->face == GridPlace::Face::ventral;
  auto law = std::make_unique<Contraction>(
      contraction_springs(model.tissue, furrow, {.stiffness = 3, .across_ratio = 0.4}), Program{});
  model.laws.push_back(std::move(law));
  add_drag(model);
  return model;
}

TEST(DivisionStress, FiveRandomRoundsToTenThousandCells) {
  Model model = contracting_pill();
  State state = rest_state(model), next;
  Random random(20261121);
  for (int round = 1; round <= 5; ++round) {
    divide_cells(model, state, random_divisions(model.tissue, 0.7, random));
    NewtonStepper solver(model);
    double worst_volume = 0, worst_jacobian = 1;
    for (const double duration_s : {0.5, 5.0, 20.0}) {
      const StepReport report = solver.advance(state, duration_s, false, next);
      ASSERT_TRUE(report.converged()) << report.reason() << " in round " << round;
      state = next;
      for (const double error : model.volumes.relative_errors(state.positions))
        worst_volume = std::max(worst_volume, std::abs(error));
    }
    for (const auto& element : model.tissue.elements)
      worst_jacobian = std::min(worst_jacobian, hex_scaled_jacobian(gather(state.positions, element)));
    for (const Vec3& x : state.positions) ASSERT_TRUE(x.allFinite());
    EXPECT_LE(worst_volume, 1e-9);
    EXPECT_GT(worst_jacobian, 0);
    EXPECT_NEAR(volume_of_cells(model.tissue, state.positions) / volume_inside_boundary(model.tissue, state.positions),
                1, 1e-12);
    std::cout << "round " << round << ": " << model.tissue.cells.size() << " cells, " << model.tissue.elements.size()
              << " elements, " << model.tissue.free_node_count() << " free and " << model.tissue.hanging.size()
              << " hanging nodes; volumes to " << worst_volume << ", scaled Jacobian from " << worst_jacobian << "\n";
  }
  EXPECT_GT(model.tissue.cells.size(), 10000u);
}

// A sheet held at one end and bent by a small load at the other, volumes held: as soft after each round of divisions as
// before. Were the new nodes to hang on the neighbours' edges, each division would add a volume and no freedom.
double deflection(Model& model, State state) {
  const double left = -80, right = 80;
  Vectors loads(model.tissue.node_count(), Vec3::Zero());
  std::vector<NodeId> end;
  for (std::size_t n = 0; n < model.tissue.free_node_count(); ++n) {
    const Vec3& x = model.tissue.rest_positions[n];
    if (x.x() < left + 1e-6) model.held[n] = {true, true, true};
    if (x.x() > right - 1e-6) end.emplace_back(n);
  }
  for (const NodeId node : end) loads[node.index()] = Vec3(0, 0, 0.1 / static_cast<double>(end.size()));
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  NewtonStepper solver(model);
  State next;
  for (int step = 0; step < 3; ++step) {
    const StepReport report = solver.advance(state, 1e7, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    state = next;
  }
  double sum = 0;
  for (const NodeId node : end)
    sum += state.positions[node.index()].z() - model.tissue.rest_positions[node.index()].z();
  model.laws.pop_back();
  return sum / static_cast<double>(end.size());
}

TEST(DivisionStress, TheSheetDoesNotStiffen) {
  Model model(build_block({.length_um = 160, .width_um = 60, .cell_height_um = 40, .cells = {8, 3, 1}}));
  add_elasticity(model);
  add_drag(model);
  State state = rest_state(model);
  Random random(3);
  const double before = deflection(model, state);
  for (int round = 1; round <= 4; ++round) {
    divide_cells(model, state, random_divisions(model.tissue, 0.6, random));
    const double now = deflection(model, state);
    EXPECT_GT(now / before, 0.99) << "round " << round;
    EXPECT_LT(now / before, 1.2) << "round " << round;
    std::cout << "round " << round << ", " << model.tissue.cells.size() << " cells: deflection " << now / before
              << " of that of the undivided sheet\n";
  }
}

}  // namespace
}  // namespace plica
