// [ablation.NAME]: cortices and contractions that lose strength. Their own tables build it (make_ablated_pattern).
#include <algorithm>

#include "core/clock.hpp"
#include "scenario/suggest.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace {

void check_ablation(const std::string& table, const AblationInput& ablation, const std::vector<std::string>& known,
                    Input& input) {
  for (const std::string& other : ablation.only)
    if (std::ranges::find(known, other) == known.end() && input.sound(table + ".only") && input.sound(other))
      input.report(table + ".only", fmt::format("[{}] does not exist", other), did_you_mean(other, known));
  for (const std::string key : {"", ".at_s", ".at_min", ".until_s", ".until_min"})
    if (!input.sound(table + key)) return;
  if (!ablation.at_s) return input.report(table, "no start time", "set at_min or at_s (0 = from the start)");
  if (ablation.until_s && has_come(*ablation.until_s, *ablation.at_s))
    input.report(table + ".until_s", "is not after the start of the ablation", "set a later time, or \"none\"");
}

void check_ablations(Scenario& scenario, Input& input) {
  std::vector<std::string> known;  // that `only` may name
  for (const Acting& acting : acting_tables(scenario))
    if (acting.can_be_ablated) known.push_back(acting.table);
  for (const auto& [name, it] : scenario.ablations) check_ablation("ablation." + name, it, known, input);
}

}  // namespace

ScenarioTable ablation_table() {
  using A = AblationInput;
  ScenarioTable info{
      "ablation.*", "Laser ablation or optogenetic inhibition: loss of cortical and contractile strength.", "Activity"};
  const auto row = key_rows(info, &Scenario::ablations);
  info.rows = {
      row("region", &A::region, anything, "Cells that lose strength.", {.required = true}),
      row("faces", &A::faces, one_of(words::edges),
          "Affected faces: cortices lose tension and stiffness, contractions of their edges all forces. A lateral face "
          "keeps the half of a neighbour outside the region."),
      row("only", &A::only, anything,
          "Affected tables, such as [\"cortex.apical\"]; [] for all. A laser cuts the whole cortex, light inactivates "
          "its myosin.",
          {.may_be_empty = true}),
      row("at_s", &A::at_s, not_negative, "Start (s); 0: from the beginning."),
      row("at_min", &A::at_s, not_negative, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
      row("until_s", &A::until_s, positive_or_none, "End (s); none: permanent."),
      row("until_min", &A::until_s, positive_or_none, "`until_s` in minutes.", {.instead_of = "until_s", .scale = 60}),
      row("remaining", &A::remaining, between(0, 1), "Residual activity."),
  };
  info.rules = check_ablations;
  info.mirrored_regions = true;
  return info;
}

}  // namespace plica
