// [growth.NAME]: cells that grow or shrink without dividing.
#include "mechanics/growth.hpp"

#include <cmath>

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_growth {

using G = GrowthInput;

constexpr double isotropic_in_plane = 2.0 / 3, even_axis_ratio = 1;

double active_s(const ProgramInput& program) {
  return make_program(program).integral(program.time_s.front(), program.time_s.back());
}

void check_size(const std::string& table, const G& growth, Input& input) {
  for (const char* key : {"", ".rate_per_h", ".final_ratio", ".program", ".program.time_s", ".program.activity"})
    if (!input.sound(table + key)) return;
  if (growth.rate_per_h && growth.final_ratio)
    return input.report(table + ".final_ratio", "conflicts with rate_per_h, which is also set", "remove one of them");
  if (!growth.rate_per_h && !growth.final_ratio)
    input.report(table, "has no effect", "set rate_per_h, or final_ratio with a program");
  const ProgramInput& program = growth.program;
  if (!growth.final_ratio || program.time_s.size() != program.activity.size()) return;
  if (program.time_s.empty())
    input.report(table + ".program", "is missing: final_ratio is reached over its course",
                 "set program, for example to { time_min = [0, 60], activity = [1, 1] }");
  else if (!(active_s(program) > 0))
    input.report(table + ".program.activity", "has no integral over time, so final_ratio is never reached",
                 "set two times or more, with an activity above 0");
}

void check(const std::string& table, G& growth, const Scenario& scenario, Input& input) {
  check_size(table, growth, input);
  check_follow(table, growth.follow, scenario, input);
  if (input.sound(table + ".axis") && input.sound(table + ".axis_ratio")) {
    if (growth.axis_ratio && growth.axis.empty())
      input.report(table + ".axis", "is missing", "set axis to \"along\" or \"across\"");
    if (!growth.axis.empty() && !growth.axis_ratio)
      input.report(table + ".axis_ratio", "is missing", "set axis_ratio to growth along the axis / growth across it");
    if (growth.axis_ratio && growth.in_plane == 0.0)
      input.report(table + ".axis_ratio", "is not used with in_plane 0, growth in height",
                   "remove axis and axis_ratio");
  }
}

GrowthRule rule_of(const G& input) {
  constexpr double seconds_an_hour = 3600;
  GrowthRule rule{input.rate_per_h.value_or(0) / seconds_an_hour, {}, make_program(input.program)};
  if (input.final_ratio) {  // the last point ends it
    ProgramInput program = input.program;
    rule.rate_per_s = std::log(*input.final_ratio) / active_s(program);
    program.time_s.push_back(program.time_s.back());
    program.activity.push_back(0);
    program.time_s.insert(program.time_s.begin(), program.time_s.front());
    program.activity.insert(program.activity.begin(), 0);
    rule.program = make_program(program);
  }
  const double in_plane = input.in_plane.value_or(isotropic_in_plane),
               ratio = input.axis_ratio.value_or(even_axis_ratio);
  const double on_axis = in_plane * ratio / (1 + ratio), off_axis = in_plane / (1 + ratio);
  rule.shares = {on_axis, off_axis, 1 - in_plane};
  if (meaning_of(words::delay_axes, input.axis, PatternAxis::along) == PatternAxis::across)
    std::swap(rule.shares[0], rule.shares[1]);
  return rule;
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.growths) {
    GrowthRule rule = rule_of(input);
    rule.follow = make_follow(input.follow, scenario);
    model.laws.push_back(std::make_unique<CellGrowth>(model.tissue, make_pattern(input, origin), std::move(rule)));
    model.laws.back()->set_label("growth." + name);
  }
}

}  // namespace of_growth

ScenarioTable growth_table() {
  using namespace of_growth;
  ScenarioTable info{"growth.*",
                     "Growth of cells without division: rest shapes, target volumes and cortical reference areas. "
                     "Several tables multiply.",
                     "Activity"};
  const auto row = key_rows(info, &Scenario::growths);
  info.rows = {
      row("region", &G::region, anything, "Cells that grow.", {.required = true}),
      row("rate_per_h", &G::rate_per_h, anything,
          "Growth rate of the volume: V increases as exp(rate × time) (1/h). Negative: cells shrink."),
      row("final_ratio", &G::final_ratio, positive,
          "Instead of a rate: final / initial volume, reached at the last time of `program`."),
      row("in_plane", &G::in_plane, {.low = 0, .high = 1, .word_for_none = "isotropic"},
          "Share of the growth (of ln V) in the plane of the sheet; 1: the height stays; 0: only the height grows; "
          "isotropic: 2/3."),
      row("axis", &G::axis, one_of(words::delay_axes),
          "Axis in the plane with more or less growth: along (x) or across, projected onto each cell."),
      row("axis_ratio", &G::axis_ratio, not_negative,
          "Growth (logarithm of the stretch) along `axis` / growth across it, in the plane; default 1."),
  };
  add_program(info.rows, row, &G::program);
  add_follow(info.rows, row);
  add_strengths(info.rows, acting(row));
  info.build = build;
  list_acting(info, &Scenario::growths, nullptr, check);
  return info;
}

}  // namespace plica
