// [foundation.NAME]: springs and drag that hold faces to where they were.
#include "mechanics/foundation.hpp"

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_foundation {

using F = FoundationInput;

constexpr auto resistances =
    std::to_array<Word<FoundationRule::Resists>>({{"all", FoundationRule::Resists::all},
                                                  {"normal", FoundationRule::Resists::normal},
                                                  {"one-sided", FoundationRule::Resists::one_sided}});

void check(const std::string& table, F& input, const Scenario& scenario, Input& errors) {
  const bool follows = check_follow(table, input.follow, scenario, errors);
  for (const char* key : {"", ".stiffness_nN_per_um3", ".drag_Pa_s_per_um"})
    if (!errors.sound(table + key)) return;
  const auto is_missing = [&](double value, const std::string& key) {
    return value == 0 && errors.place(table + key) == nullptr;
  };
  if (is_missing(input.stiffness_nN_per_um3, ".stiffness_nN_per_um3")) {
    if (is_missing(input.drag_Pa_s_per_um, ".drag_Pa_s_per_um"))
      errors.report(table, "has no effect", "set stiffness_nN_per_um3 or drag_Pa_s_per_um");
    if (!input.program.activity.empty())
      errors.report(table + ".program", "is not used without stiffness_nN_per_um3",
                    "remove it, or set stiffness_nN_per_um3");
    if (follows)
      errors.report(table + ".follow", "is not used without stiffness_nN_per_um3",
                    "remove it, or set stiffness_nN_per_um3");
    if (input.resists == "one-sided")
      errors.report(table + ".resists", "\"one-sided\" is not used without stiffness_nN_per_um3",
                    "set resists to \"all\" or \"normal\", or set stiffness_nN_per_um3");
  }
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.foundations) {
    if (input.stiffness_nN_per_um3 == 0 && input.drag_Pa_s_per_um == 0) continue;
    FoundationRule rule{meaning_of(words::surfaces, input.faces),
                        input.stiffness_nN_per_um3,
                        input.drag_Pa_s_per_um * units::pascal_second_per_um,
                        meaning_of(resistances, input.resists),
                        make_program(input.program),
                        make_follow(input.follow, scenario)};
    model.laws.push_back(std::make_unique<Foundation>(model.tissue, make_pattern(input, origin), std::move(rule)));
    model.laws.back()->set_label("foundation." + name);
  }
}

void describe(const F&, const Scenario&, Acting& acting) { acting.faces_key = "faces"; }

}  // namespace of_foundation

ScenarioTable foundation_table() {
  using namespace of_foundation;
  ScenarioTable info{"foundation.*",
                     "Elastic, viscous foundation: holds cell faces to their reference positions, as a substrate does.",
                     "Surroundings"};
  const auto row = key_rows(info, &Scenario::foundations);
  info.rows = {
      row("region", &F::region, anything, "Cells whose faces are held.", {.required = true}),
      row("faces", &F::faces, one_of(words::surfaces), "Held faces."),
      row("stiffness_nN_per_um3", &F::stiffness_nN_per_um3, not_negative,
          "Winkler modulus: force per displacement and reference area (nN/µm³ = kPa/µm)."),
      row("drag_Pa_s_per_um", &F::drag_Pa_s_per_um, not_negative,
          "Drag: force per velocity and reference area (Pa s/µm), in addition to that of `[dynamics]`."),
      row("resists", &F::resists, one_of(resistances),
          "Displacements that meet resistance: all; along the reference normal only (faces slide); or one-sided, along "
          "it and only into the foundation (faces slide and lift off; drag along the normal remains)."),
  };
  add_program(info.rows, row, &F::program);
  add_follow(info.rows, row);
  add_strengths(info.rows, acting(row));
  info.build = build;
  list_acting(info, &Scenario::foundations, describe, check);
  return info;
}

}  // namespace plica
