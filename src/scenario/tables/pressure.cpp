// [pressure.NAME]: dead loads on faces of cells.
#include "mechanics/surroundings.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_pressure {

using P = PressureInput;

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.pressures) {
    model.laws.push_back(std::make_unique<FacePressure>(
        model.tissue, meaning_of(words::surfaces, input.faces), make_pattern(input, origin),
        input.pressure_Pa * units::pascal, make_program(input.program),
        FollowedSignal(model.tissue, make_follow(input.follow, scenario))));
    model.laws.back()->set_label("pressure." + name);
  }
}

void check(const std::string& table, P& input, const Scenario& scenario, Input& errors) {
  check_follow(table, input.follow, scenario, errors);
}

void describe(const P& input, const Scenario& scenario, Acting& acting) {
  acting.faces_key = "face";
  acting.has_sudden_onset = !input.follow.is_used();
  acting.forces = {{"pressure_Pa", input.pressure_Pa, scenario.elasticity.young_modulus_Pa}};
}

}  // namespace of_pressure

ScenarioTable pressure_table() {
  using namespace of_pressure;
  ScenarioTable info{"pressure.*", "Pressure on cell faces.", "Surroundings"};
  const auto row = key_rows(info, &Scenario::pressures);
  info.rows = {
      row("region", &P::region, anything, "Cells whose faces carry the pressure.", {.required = true}),
      row("face", &P::faces, one_of(words::surfaces), "Loaded face."),
      row("pressure_Pa", &P::pressure_Pa, anything, "Pressure into the cell (Pa); dead load on the reference face.",
          {.required = true}),
  };
  add_program(info.rows, row, &P::program);
  add_follow(info.rows, row);
  add_strengths(info.rows, acting(row));
  info.build = build;
  list_acting(info, &Scenario::pressures, describe, check);
  return info;
}

}  // namespace plica
