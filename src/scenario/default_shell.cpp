#include "scenario/default_shell.hpp"

#include <exception>

#include "core/errors.hpp"
#include "scenario/regions.hpp"
#include "scenario/setup.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

bool is_closed(const Scenario& scenario) try {
  const Tissue tissue = make_tissue(scenario);
  return encloses(tissue, tissue.apical_facets);
} catch (const std::exception&) {
  return true;  // no tissue: the reason comes where it is made
}

}  // namespace

void set_default_shell(Scenario& scenario) {
  if (shape_of(scenario.embryo) != EmbryoShape::file || scenario.given_at.contains("vitelline.enabled")) return;
  scenario.vitelline.enabled = is_closed(scenario);
  if (scenario.vitelline.enabled) return;
  if (scenario.vitelline.drag_Pa_s_per_um > 0)
    throw ScenarioError(
        {diagnostic_at(scenario, "vitelline.drag_Pa_s_per_um",
                       "is not used without a vitelline membrane, and an open tissue has none by default",
                       "remove drag_Pa_s_per_um, or set vitelline.enabled to true")});
}

}  // namespace plica
