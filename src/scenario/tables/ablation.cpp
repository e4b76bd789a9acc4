// [ablation.NAME]: cortices and contractions that lose strength. Their own tables build it (make_ablated_pattern).
#include <algorithm>

#include "core/clock.hpp"
#include "scenario/acting.hpp"
#include "scenario/suggest.hpp"
#include "scenario/tables/table.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace of_ablation {

void check_ablation(const std::string& table, const AblationInput& ablation, const std::vector<std::string>& known,
                    Input& input) {
  for (const std::string& other : ablation.only)
    if (std::ranges::find(known, other) == known.end() && input.sound(table + ".only") && input.sound(other))
      input.report(table + ".only", fmt::format("[{}] does not exist", other), did_you_mean(other, known));
  for (const std::string key : {"", ".at_s", ".at_min", ".until_s", ".until_min", ".recovery_s", ".recovery_min"})
    if (!input.sound(table + key)) return;
  if (!ablation.at_s) return input.report(table, "no start time", "set at_min or at_s (0 = from the start)");
  if (ablation.until_s && has_come(*ablation.until_s, *ablation.at_s))
    input.report(table + ".until_s", "is not after the start of the ablation", "set a later time, or \"none\"");
  if (ablation.recovery_s > 0 && !ablation.until_s)
    input.report(table + ".recovery_s", "is not used without until_s, the time at which recovery begins",
                 "set until_min, or remove it");
}

// Cuts at a height: lateral cortices only.
void check_height(const std::string& table, const AblationInput& ablation, const Scenario& scenario, Input& input) {
  const std::string key = table + ".height_percent";
  if (!ablation.height_percent || !input.sound(key, table + ".faces", table + ".only")) return;
  if (ablation.faces != std::vector<std::string>{"lateral"})
    return input.report(key, "acts on lateral faces only", "set faces to [\"lateral\"]");
  if (scenario.exchange.below_um)
    input.report(key, "faces that turn have no reference height beside [exchange]", "remove it, or remove [exchange]");
  for (const auto& [name, contraction] : scenario.contractions)
    if (takes_from(ablation, "contraction." + name, contraction.faces))
      input.report(key, fmt::format("[contraction.{}] acts along whole lateral edges", name),
                   "name the cortices to cut in `only`");
}

// A cut at a height needs faces in the range, and others.
void check_faces(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  for (const auto& [name, ablation] : scenario.ablations) {
    if (!ablation.height_percent) continue;
    const CellSet& region = tissue.regions.at(ablation.region);
    std::array<int, 2> count = {0, 0};  // outside, inside
    for (const Face& face : faces_of(tissue, CellSide::lateral)) {
      const double height = height_percent(tissue, face.cell, face.nodes);
      const auto& [low, high] = *ablation.height_percent;
      if (region[face.cell.index()] || (face.beyond && region[face.beyond->index()]))
        ++count[height >= low && height <= high ? 1 : 0];
    }
    if (count[0] == 0 || count[1] == 0)
      errors.push_back(diagnostic_at(
          scenario, fmt::format("ablation.{}.height_percent", name),
          fmt::format("{} lateral face of the region has its centre in this part of the height",
                      count[1] == 0 ? "no" : "every"),
          fmt::format("change height_percent, or increase {}", is_of_grid(shape_of(scenario.embryo))
                                                                   ? "embryo.elements_per_cell through the height"
                                                                   : "embryo.layers")));
  }
}

void check_ablations(Scenario& scenario, Input& input) {
  std::vector<std::string> known;  // that `only` may name
  for (const Acting& acting : acting_tables(scenario))
    if (acting.can_be_ablated) known.push_back(acting.table);
  for (const auto& [name, it] : scenario.ablations) {
    check_ablation("ablation." + name, it, known, input);
    check_height("ablation." + name, it, scenario, input);
  }
}

}  // namespace of_ablation

ScenarioTable ablation_table() {
  using namespace of_ablation;
  using A = AblationInput;
  ScenarioTable info{
      "ablation.*", "Laser ablation or optogenetic inhibition: loss of cortical and contractile strength.", "Activity"};
  const auto row = key_rows(info, &Scenario::ablations);
  info.rows = {
      row("region", &A::region, anything, "Cells that lose strength.", {.required = true}),
      row("faces", &A::faces, one_of(words::edges),
          "Affected faces: cortices lose tension and stiffness, contractions of their edges all forces. A lateral face "
          "keeps the half of a neighbour outside the region."),
      row("height_percent", &A::height_percent, between(0, 100),
          "Lateral cortices: only faces with their centre in this part of the height (0: basal, 100: apical)."),
      row("only", &A::only, anything,
          "Affected tables, such as [\"cortex.apical\"]; [] for all. A laser cuts the whole cortex, light inactivates "
          "its myosin.",
          {.may_be_empty = true}),
      row("at_s", &A::at_s, not_negative, "Start (s); 0: from the beginning."),
      row("at_min", &A::at_s, not_negative, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
      row("until_s", &A::until_s, positive_or_none, "End (s); none: permanent."),
      row("until_min", &A::until_s, positive_or_none, "`until_s` in minutes.", {.instead_of = "until_s", .scale = 60}),
      row("recovery_s", &A::recovery_s, not_negative, "Then, time in which strength returns (s)."),
      row("recovery_min", &A::recovery_s, not_negative, "`recovery_s` in minutes.",
          {.instead_of = "recovery_s", .scale = 60}),
      row("remaining", &A::remaining, between(0, 1), "Residual activity."),
  };
  info.rules = check_ablations;
  info.check = check_faces;
  info.mirrored_regions = true;
  return info;
}

}  // namespace plica
