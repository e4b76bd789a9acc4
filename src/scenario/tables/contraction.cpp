// [contraction.NAME]: springs on edges of cells.
#include "mechanics/active/contraction.hpp"

#include <algorithm>

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_contraction {

using C = ContractionInput;

// A cable is a line: keys of faces do not apply.
void check_border(const std::string& table, const C& contraction, Input& input) {
  if (contraction.border.empty() || !input.sound(table + ".border")) return;
  const auto refuse = [&](const char* key, bool is_set, const std::string& remedy) {
    if (is_set && input.sound(table + key))
      input.report(table + key, "conflicts with `border`, which makes a cable", remedy);
  };
  refuse(".edges", contraction.faces == "lateral", "set edges to \"apical\" or \"basal\"");
  refuse(".diagonals", contraction.diagonals, "remove one of them");
  refuse(".tension_mN_per_m", contraction.tension_mN_per_m > 0, "set the tension of the cable as preload_nN");
}

void check_contraction(const std::string& table, C& contraction, const Scenario& scenario, Input& input) {
  check_border(table, contraction, input);
  if (!check_follow(table, contraction.follow, scenario, input)) return;
  bool acts = false;
  for (const auto& [key, value] : {std::pair(".stiffness_nN_per_um", contraction.stiffness_nN_per_um),
                                   {".preload_nN", contraction.preload_nN},
                                   {".tension_mN_per_m", contraction.tension_mN_per_m}})
    acts = acts || value != 0 || !input.sound(table + key) || input.place(table + key) != nullptr;
  if (!acts)
    input.report(table + ".follow", "is not used without stiffness, pre-tension or tension",
                 "remove it, or set stiffness_nN_per_um, preload_nN or tension_mN_per_m");
}

OtherSide other_side(const C& contraction, const Tissue& tissue) {
  return {tissue.regions.at(contraction.border), contraction.border == "all"};
}

// Diagonals are those of four-sided faces, and a cable needs a border.
void check_edges(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  for (const auto& [name, it] : scenario.contractions) {
    if (!it.border.empty()) {
      const auto lines = border_lines(tissue, CellSide::apical, tissue.regions.at(it.region), other_side(it, tissue));
      if (std::ranges::all_of(lines, [](const auto& of_cell) { return of_cell.empty(); }))
        errors.push_back(diagnostic_at(scenario, "contraction." + name + ".border",
                                       fmt::format("region \"{}\" has no edge there", it.region),
                                       "set it to a region beside it, or to \"all\""));
    }
    if (!it.diagonals) continue;
    const CellSet& region = tissue.regions.at(it.region);
    for (std::size_t c = 0; c < region.size(); ++c)
      if (region[c] && tissue.cells[c].sides() != 4) {
        errors.push_back(
            diagnostic_at(scenario, "contraction." + name + ".diagonals",
                          fmt::format("{} has {} corners, but diagonals are defined for four-sided cells only",
                                      cell_at(tissue, CellId(c)), tissue.cells[c].sides()),
                          "set diagonals to false"));
        break;
      }
  }
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.contractions) {
    ContractionRule rule;
    rule.side = meaning_of(words::edges, input.faces);
    rule.stiffness = input.stiffness_nN_per_um;
    rule.along_ratio = input.along_ratio;
    rule.across_ratio = input.across_ratio;
    rule.diagonals = input.diagonals;
    rule.rest_length_ratio = input.rest_length_ratio;
    rule.preload = input.preload_nN;
    rule.damping = input.damping_nN_s_per_um;
    rule.tension = input.tension_mN_per_m;  // nN/um = mN/m
    if (!input.border.empty()) {
      const CellSet& beyond = origin.whole.regions.at(input.border);
      for (std::size_t c = 0; c < beyond.size(); ++c)
        if (beyond[c] != beyond[origin.mirror.original(CellId(c)).index()])
          throw_at(scenario, "contraction." + name + ".border",
                   fmt::format("region \"{}\" is not symmetric", input.border),
                   "use a symmetric region, or remove embryo.mirror");
      rule.border = other_side(input, model.tissue);
    }
    const std::string table = "contraction." + name;
    CellPattern pattern = make_ablated_pattern(scenario, table, input, origin);
    std::vector<Spring> springs = contraction_springs(model.tissue, pattern, rule);
    model.laws.push_back(
        std::make_unique<Contraction>(std::move(springs), make_program(input.program), std::move(pattern),
                                      FollowedSignal(model.tissue, make_follow(input.follow, scenario))));
    model.laws.back()->set_label(table);
  }
}

void describe(const C& input, const Scenario& scenario, Acting& acting) {
  const double stress = scenario.elasticity.young_modulus_Pa * units::pascal, height = scenario.embryo.cell_height_um;
  // Lateral edges are long and pull on the small area of a cell.
  const double shape = input.faces == "lateral" ? 0.01 : 1;
  acting.faces_key = "edges";
  acting.can_be_ablated = acting.contracts = true;
  acting.has_sudden_onset = !input.follow.is_used();
  // A tension that falls with the length on which it acts ends softly by itself; a cable runs along the border.
  acting.is_constant = input.faces != "lateral" && input.stiffness_nN_per_um == 0 && input.border.empty() &&
                       (input.tension_mN_per_m > 0 || input.preload_nN > 0) && !input.follow.is_used();
  acting.forces = {{"stiffness_nN_per_um", input.stiffness_nN_per_um, shape * stress * height},
                   {"preload_nN", input.preload_nN, 0.01 * stress * height * height},
                   {"tension_mN_per_m", input.tension_mN_per_m, stress * height}};
}

}  // namespace of_contraction

ScenarioTable contraction_table() {
  using namespace of_contraction;
  ScenarioTable info{"contraction.*", "Contractile springs on cell edges.", "Activity"};
  const auto row = key_rows(info, &Scenario::contractions);
  info.rows = {
      row("region", &C::region, anything, "Cells that contract.", {.required = true}),
      row("edges", &C::faces, one_of(words::edges), "Edges that carry springs."),
      row("border", &C::border, anything,
          "Cable: only edges shared with cells of this region outside their own; `all`: with all others, and a rim."),
      row("stiffness_nN_per_um", &C::stiffness_nN_per_um, not_negative, "Spring stiffness (nN/µm)."),
      row("along_ratio", &C::along_ratio, not_negative, "Factor on edges along the axis."),
      row("across_ratio", &C::across_ratio, not_negative, "Factor on edges across the axis."),
      row("diagonals", &C::diagonals, anything, "Add springs on face diagonals."),
      row("rest_length_ratio", &C::rest_length_ratio, not_negative, "Slack length / initial length."),
      row("preload_nN", &C::preload_nN, anything, "Pre-tension of a spring, independent of length (nN)."),
      row("tension_mN_per_m", &C::tension_mN_per_m, not_negative,
          "Tension per length across the face (mN/m = nN/µm), independent of cell size. Stiffness and pre-tension act "
          "on every edge, so smaller cells contract more strongly."),
      row("damping_nN_s_per_um", &C::damping_nN_s_per_um, not_negative, "Spring damping (nN s/µm)."),
  };
  add_program(info.rows, row, &C::program);
  add_follow(info.rows, row);
  add_pattern(info.rows, acting(row));
  info.check = check_edges;
  info.build = build;
  list_acting(info, &Scenario::contractions, describe, check_contraction);
  info.regions = [own = info.regions](const Scenario& scenario, const TakeRegion& take) {
    own(scenario, take);
    for (const auto& [name, it] : scenario.contractions) take("contraction." + name + ".border", it.border);
  };
  return info;
}

}  // namespace plica
