// [self_contact]: surfaces of the sheet that repel one another.
#include "mechanics/contact/self_contact.hpp"

#include <algorithm>

#include "measure/self_intersections.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_self_contact {

void check_contact(Scenario& scenario, Input& input) {
  if (!input.sound("self_contact") || !input.sound("self_contact.surface")) return;
  const SelfContactInput& contact = scenario.self_contact;
  if (contact.surface == "none" && contact.friction > 0 && input.sound("self_contact.friction"))
    input.report("self_contact.friction", "is not used with surface \"none\"",
                 "remove friction, or set surface, for example to \"apical\"");
  if (contact.surface == "none") return;
  if (contact.search_um < 2 * contact.distance_um && input.sound("self_contact.search_um"))
    input.report("self_contact.search_um", fmt::format("{} is below twice distance_um", contact.search_um),
                 "set search_um to several times distance_um");
}

// Contact requires a reference mesh without self-intersections: otherwise the two sides cannot be distinguished.
void check_contact_at_rest(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (scenario.self_contact.surface == "none") return;
  const CellSet crossing = self_intersecting_cells(tissue, tissue.rest_positions);
  const auto first = std::ranges::find(crossing, true);
  if (first != crossing.end())
    errors.push_back(
        diagnostic_at(scenario, "self_contact.surface",
                      fmt::format("the reference mesh self-intersects at {}",
                                  cell_at(tissue, CellId(static_cast<std::size_t>(first - crossing.begin())))),
                      "repair the mesh, or set surface to \"none\""));
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  const SelfContactInput& input = scenario.self_contact;
  const ContactSurface surface = meaning_of(words::contact_surfaces, input.surface);
  for (const auto& [side, alone] :
       {std::pair(CellSide::apical, ContactSurface::apical), {CellSide::basal, ContactSurface::basal}})
    if (surface == alone || surface == ContactSurface::both) {
      model.laws.push_back(std::make_unique<SelfContact>(
          origin.whole,
          SelfContactRule{side, input.distance_um, input.stiffness_kPa_per_um, input.search_um, input.friction},
          origin.mirror));
      model.laws.back()->set_label(side == CellSide::apical ? "self_contact.apical" : "self_contact.basal");
    }
}

}  // namespace of_self_contact

ScenarioTable self_contact_table() {
  using namespace of_self_contact;
  using F = SelfContactInput;
  ScenarioTable info{"self_contact", "Contact of the sheet with itself.", "Surroundings"};
  const auto row = key_rows("self_contact", &Scenario::self_contact);
  info.rows = {
      row("surface", &F::surface, one_of(words::contact_surfaces), "Surfaces that resist self-intersection."),
      row("distance_um", &F::distance_um, positive, "Distance at which repulsion starts (µm)."),
      row("stiffness_kPa_per_um", &F::stiffness_kPa_per_um, positive,
          "Contact pressure per µm below that distance (kPa/µm). At the pressure between furrow lips, tens of Pa, the "
          "overlap is about 0.1 µm."),
      row("search_um", &F::search_um, positive,
          "Search distance at the start of a step (µm); must exceed the motion in a step."),
      row("friction", &F::friction, not_negative,
          "Coefficient of friction: tangential / normal force at which sliding starts. 0: frictionless."),
  };
  info.rules = check_contact;
  info.check = check_contact_at_rest;
  info.build = build;
  return info;
}

}  // namespace plica
