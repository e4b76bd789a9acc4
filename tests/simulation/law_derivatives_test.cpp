// Each law of each built-in scenario has right derivatives for gradients, or refuses.
#include <set>

#include "mechanics/derivatives.hpp"
#include "scenario/builtin.hpp"
#include "simulation/simulation.hpp"
#include "support/law_checks.hpp"
#include "support/scenarios.hpp"

namespace {

TEST(LawDerivatives, OfBuiltInScenariosAgreeWithDifferences) {
  std::set<std::string> checked;
  for (const BuiltinScenario& builtin : builtin_scenarios()) {
    // Not checked: with so many cells, some faces of cortex.walls pass their rest area, a kink, within each difference.
    // The same laws are in furrow-slice, and those of drosophila-atlas in drosophila.
    if (builtin.name.starts_with("drosophila-living") || builtin.name.starts_with("drosophila-atlas")) continue;
    const Simulation::Parts parts = parts_of(load_scenario(find_scenario(std::string(builtin.name)), {}));
    const Model& model = *parts.model;
    for (const auto& law : model.laws) {
      SCOPED_TRACE(fmt::format("{}: {}", builtin.name, law->label()));
      if (!has_derivatives(*law)) continue;
      checked.emplace(law->name());
      // Growth is no force, and what follows signals is moved to them (Tape.GradientsThroughSignals).
      const bool with_memory = !law->derivatives().strengths_change_cells() && model.signals.empty();
      check_law_derivatives(*law, model.tissue, 0.1, law->first_internal(model.tissue), 1e-5, with_memory);
    }
  }
  EXPECT_GE(checked.size(), 13u);
}

}  // namespace
