// Derivatives of the cortex by what a step begins with: relaxation, shape-dependent activity, polarity and noise.
#include "mechanics/active/cortex.hpp"
#include "support/cortices.hpp"
#include "support/law_checks.hpp"

namespace {

const CellSet every_cell(6, true);

Tissue six_cells() {
  return distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
}

TEST(CortexDerivatives, OfARunAgreeWithFiniteDifferences) {
  const Tissue tissue = six_cells();
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    const Cortex law(tissue, every_cell, whole_cortex(side));
    std::vector<double> internal = law.first_internal(tissue);
    Random random(4);
    for (double& ratio : internal) ratio += random.number(0.2);
    check_law_derivatives(law, tissue, 2, internal);
  }
}

// Cells that have started, that start in the step, and that do not; and cells that follow their shape. Beside flow.
TEST(CortexDerivatives, OfShapeDependentActivityAgreeWithFiniteDifferences) {
  const Tissue tissue = six_cells();
  using Kind = ShapeActivationRule::Kind;
  for (const ShapeMeasure measure : {ShapeMeasure::apical_area_ratio, ShapeMeasure::basal_area_ratio,
                                     ShapeMeasure::height_ratio, ShapeMeasure::apical_stretch})
    for (const auto& [kind, of_neighbours] : {std::pair(Kind::starts_below, false),
                                              {Kind::starts_above, false},
                                              {Kind::starts_above, true},
                                              {Kind::follows, false},
                                              {Kind::follows, true}}) {
      CortexRule rule = whole_cortex(CellSide::lateral);
      rule.activation = {
          .kind = kind, .measure = measure, .threshold = 1.05, .from = 0.7, .to = 1.5, .of_neighbours = of_neighbours};
      const Cortex law(tissue, every_cell, rule);
      const auto smooth = law.smooth();
      const Law& recorded = smooth ? *smooth : static_cast<const Law&>(law);
      std::vector<double> internal = recorded.first_internal(tissue);
      const std::size_t first = internal.size() - tissue.cells.size();
      for (std::size_t c = 0; c < tissue.cells.size(); ++c)
        internal[first + c] = kind == Kind::follows ? 0.1 + 0.1 * static_cast<double>(c)
                              : c < 2               ? 0.3 + 0.2 * static_cast<double>(c)
                                                    : ShapeActivation::not_yet;
      SCOPED_TRACE(testing::Message() << static_cast<int>(measure) << ", " << static_cast<int>(kind) << ", "
                                      << of_neighbours);
      check_law_derivatives(recorded, tissue, 2, internal, 5e-6);
    }
}

TEST(CortexDerivatives, OfPolarityAndNoiseAgreeWithFiniteDifferences) {
  const Tissue tissue = six_cells();
  for (const bool across : {false, true}) {
    CortexRule rule = whole_cortex(CellSide::lateral);
    rule.walls = {WallDirection{across, 1.6, 0.4}, {.spread = 0.5, .correlation_s = 10, .seed = 3}};
    const Cortex law(tissue, every_cell, rule);
    check_law_derivatives(law, tissue, 2, law.first_internal(tissue));
  }
}

TEST(CortexDerivatives, RefusesDerivativesWhereAForceJumpsAtATriggersTime) {
  const Tissue tissue = six_cells();
  const auto refused = [&](const Program& program, const Program& stiffness_program) {
    CortexRule rule{.tension = 1, .stiffness = 1, .program = program, .stiffness_program = stiffness_program};
    rule.activation.kind = ShapeActivationRule::Kind::starts_below;
    return error_of<NoGradient>([&] { return &Cortex(tissue, every_cell, rule).derivatives(); });
  };
  EXPECT_EQ(refused(Program({0, 1}, {0, 1}), {}), "");
  EXPECT_SAYS(refused({}, {}), "let its program rise from activity 0, or start at a given time");
  EXPECT_SAYS(refused(Program({0, 1, 1}, {0, 1, 0}), {}), "cortex: a jump");
  EXPECT_SAYS(refused(Program({0, 1}, {0, 1}), Program({1, 1}, {1, 0})), "cortex: a jump");
}

}  // namespace
