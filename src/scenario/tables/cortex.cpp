// [cortex.NAME]: a thin active, elastic layer on faces of cells.
#include "mechanics/active/cortex.hpp"

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_cortex {

using X = CortexInput;

void check_effect(const std::string& table, const CortexInput& cortex, Input& input) {
  for (const char* key : {"", ".tension_mN_per_m", ".stiffness_mN_per_m", ".crowding_mN_per_m"})
    if (!input.sound(table + key)) return;
  // A value set to 0 is switched off on purpose, so the keys that depend on it are no error.
  const auto is_missing = [&](double value, const std::string& name) {
    return value == 0 && input.place(table + "." + name) == nullptr;
  };
  if (is_missing(cortex.tension_mN_per_m, "tension_mN_per_m") &&
      is_missing(cortex.stiffness_mN_per_m, "stiffness_mN_per_m") &&
      is_missing(cortex.crowding_mN_per_m, "crowding_mN_per_m"))
    input.report(table, "has no effect", "set tension_mN_per_m, stiffness_mN_per_m or crowding_mN_per_m");
  // Keys that modify a missing quantity.
  const auto needs = [&](const std::string& key, bool is_given, double what, const std::string& name) {
    if (is_given && is_missing(what, name))
      input.report(table + key, "is not used without " + name, "remove it, or set " + name);
  };
  needs(".saturation_ratio", cortex.saturation_ratio > 0, cortex.tension_mN_per_m, "tension_mN_per_m");
  needs(".program", !cortex.program.activity.empty(), cortex.tension_mN_per_m, "tension_mN_per_m");
  needs(".compression_ratio", cortex.compression_ratio < 1, cortex.stiffness_mN_per_m, "stiffness_mN_per_m");
  needs(".relaxation_s", cortex.relaxation_s.has_value(), cortex.stiffness_mN_per_m, "stiffness_mN_per_m");
  needs(".stiffness_program", !cortex.stiffness_program.activity.empty(), cortex.stiffness_mN_per_m,
        "stiffness_mN_per_m");
}

void check_shape_activation(const std::string& table, const CortexInput& cortex, const Scenario& scenario,
                            Input& input) {
  const TriggerInput& trigger = cortex.trigger;
  const FollowInput& follow = cortex.follow;
  for (const std::string& part : {table, table + ".trigger", table + ".follow"})
    if (!input.sound(part)) return;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(table + key)) input.report(table + key, problem, remedy);
  };
  if (check_reading(table + ".trigger", trigger, trigger.below || trigger.above, scenario, input, true)) {
    if (trigger.below.has_value() == trigger.above.has_value())
      report(trigger.below ? ".trigger.above" : ".trigger.below", trigger.below ? "conflicts with below" : "is missing",
             "set either below or above");
    if (cortex.delay.speed_um_per_s)
      report(".trigger", "conflicts with `delay`, which activates cells at prescribed times", "remove one of them");
  }
  if (!check_follow(table, follow, scenario, input, true)) return;
  if (trigger.is_used()) report(".follow", "conflicts with `trigger`", "remove one of them");
  if (cortex.tension_mN_per_m == 0 && input.place(table + ".tension_mN_per_m") == nullptr)
    report(".follow", "is not used without tension_mN_per_m", "remove it, or set tension_mN_per_m");
}

void check_direction(const std::string& table, const CortexInput& cortex, const Scenario& scenario, Input& input) {
  const auto& [axis, array, strongest, weakest] = cortex.direction;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(table, table + ".direction" + key, table + ".faces"))
      input.report(table + ".direction" + key, problem, remedy);
  };
  if (axis.empty() && (strongest != 1 || weakest != 1 || !array.empty()))
    report(".axis", "is missing", "set axis to \"along\" or \"across\"");
  if (axis.empty()) return;
  if (strongest == weakest && input.sound(table + ".direction.strongest", table + ".direction.weakest"))
    report("", "has no effect, since strongest equals weakest", "set strongest above weakest");
  const bool turns = axis == "long-axis" || axis == "stretch";
  if (turns && !array.empty())
    report(".array", "conflicts with an axis of the cell", "remove it, or set axis to \"along\"");
  for (const auto& [key, value] :
       {std::pair("stiffness_mN_per_m", cortex.stiffness_mN_per_m), {"crowding_mN_per_m", cortex.crowding_mN_per_m}})
    if (turns && value > 0)
      report(".axis", fmt::format("{} cannot turn with the cell, which needs energy", key),
             fmt::format("put {} into another [cortex.NAME]", key));
  if (cortex.faces == "lateral") {
    if (turns) report(".axis", "acts on apical and basal faces only", "set axis to \"along\" or \"across\"");
    if (!array.empty()) report(".array", "acts on apical and basal faces only", "remove it, or change faces");
    return;
  }
  if (weakest > strongest)
    report(".weakest", fmt::format("{} exceeds strongest", weakest), "exchange both values, and turn axis");
  if (!array.empty() && !scenario.embryo.mirror.empty())
    report(".array", "mirror planes are not possible beside angles by cell", "remove it, or remove embryo.mirror");
  for (const auto& [other, is_used] :
       {std::pair("[exchange]", scenario.exchange.below_um.has_value()), {"[growth.NAME]", !scenario.growths.empty()}})
    if (is_used)
      report("", fmt::format("apical and basal faces have no direction beside {}", other),
             fmt::format("remove direction, or remove {}", other));
}

// Checks factors on the tension of lateral faces.
void check_walls(const std::string& table, const CortexInput& cortex, const TimeInput& time, Input& input) {
  const auto& [spread, correlation_s, seed] = cortex.noise;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(table, table + key)) input.report(table + key, problem, remedy);
  };
  if (spread > 0 && input.sound(table + ".faces") && cortex.faces != "lateral")
    report(".noise", "acts on lateral faces only", "remove it, or set faces to \"lateral\"");
  for (const auto& [part, is_used] : {std::pair(".direction", !cortex.direction.axis.empty()), {".noise", spread > 0}})
    if (is_used && input.sound(table + ".faces") && cortex.faces == "lateral" && cortex.tension_mN_per_m == 0)
      report(part, "is not used without tension_mN_per_m", "remove it, or set tension_mN_per_m");
  if (spread > 0 && !correlation_s)
    report(".noise.correlation_s", "is missing", "set it to the time in which tensions change, such as 120");
  if (spread == 0 && correlation_s)
    report(".noise.spread", "is missing", "set it to a relative deviation, such as 0.5");
  if (spread > 0 && correlation_s && time.step_s && *time.step_s > *correlation_s / 4)
    report(".noise.correlation_s", fmt::format("{} is below four times time.step_s", *correlation_s),
           "reduce time.step_s, or increase correlation_s");
}

void check_cortex(const std::string& table, CortexInput& cortex, const Scenario& scenario, Input& input) {
  check_direction(table, cortex, scenario, input);
  check_walls(table, cortex, scenario.time, input);
  check_program(table, cortex.stiffness_program, input, "stiffness_program");
  check_effect(table, cortex, input);
  check_shape_activation(table, cortex, scenario, input);
}

bool is_across(const std::string& axis) { return meaning_of(words::fibre_axes, axis) == FibreAxis::across; }

WallFactorRule make_wall_factors(const CortexInput& input) {
  WallFactorRule rule;
  if (const auto& [axis, array, strongest, weakest] = input.direction; input.faces == "lateral" && !axis.empty())
    rule.direction = WallDirection{is_across(axis), strongest, weakest};
  rule.noise = {input.noise.spread, input.noise.correlation_s.value_or(0),
                static_cast<std::uint64_t>(input.noise.seed)};
  return rule;
}

// Gives apical and basal faces fibres, and their tension its value along them.
void take_fibres(const DirectionInput& input, const Tissue& tissue, CortexRule& rule) {
  if (rule.side == CellSide::lateral || input.axis.empty()) return;
  rule.fibres = {1 - input.weakest / input.strongest,
                 is_across(input.axis) ? 90.0 : 0.0,
                 {},
                 meaning_of(words::fibre_axes, input.axis)};
  if (!input.array.empty()) rule.fibres.angles_deg = tissue.cell_arrays.at(input.array);
  for (double* value : {&rule.tension, &rule.stiffness, &rule.crowding}) *value *= input.strongest;
}

ShapeActivationRule make_shape_activation(const CortexInput& input, const Scenario& scenario) {
  if (!input.trigger.is_used()) return make_follow(input.follow, scenario);
  ShapeActivationRule rule = make_reading(input.trigger, scenario);
  const std::optional<double>& below = input.trigger.below;
  rule.kind = below ? ShapeActivationRule::Kind::starts_below : ShapeActivationRule::Kind::starts_above;
  rule.threshold = reading_unit(rule) * (below ? *below : *input.trigger.above);
  return rule;
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  for (const auto& [name, input] : scenario.cortices) {
    if (input.tension_mN_per_m == 0 && input.stiffness_mN_per_m == 0 && input.crowding_mN_per_m == 0) continue;
    CortexRule rule;  // nN/um = mN/m
    rule.side = meaning_of(words::edges, input.faces);
    rule.tension = input.tension_mN_per_m;
    rule.saturation = input.saturation_ratio;
    rule.stiffness = input.stiffness_mN_per_m;
    rule.compression_ratio = input.compression_ratio;
    rule.crowding = input.crowding_mN_per_m;
    rule.relaxation_s = input.relaxation_s.value_or(0);
    rule.program = make_program(input.program);
    rule.stiffness_program = make_program(input.stiffness_program);
    rule.activation = make_shape_activation(input, scenario);
    rule.walls = make_wall_factors(input);
    take_fibres(input.direction, origin.whole, rule);
    const std::string table = "cortex." + name;
    CellPattern pattern = make_ablated_pattern(scenario, table, input, origin);
    model.laws.push_back(std::make_unique<Cortex>(model.tissue, std::move(pattern), std::move(rule)));
    model.laws.back()->set_label(table);
  }
}

void check_arrays(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  for (const auto& [name, input] : scenario.cortices)
    if (!input.direction.array.empty())
      check_array(scenario, fmt::format("cortex.{}.direction.array", name), input.direction.array, input.region, tissue,
                  errors);
}

void describe(const X& input, const Scenario& scenario, Acting& acting) {
  acting.faces_key = "faces";
  acting.can_be_ablated = true;
  acting.contracts = input.faces == "apical" && input.tension_mN_per_m > 0;
  // A tension that falls with the area on which it acts ends softly by itself.
  acting.is_constant = input.faces != "lateral" && input.tension_mN_per_m > 0 && input.saturation_ratio == 0 &&
                       input.stiffness_mN_per_m == 0 && input.crowding_mN_per_m == 0 && !input.follow.is_used();
  acting.has_sudden_onset = input.tension_mN_per_m > 0 && !input.trigger.is_used() && !input.follow.is_used();
  acting.forces = {{"tension_mN_per_m", input.tension_mN_per_m,
                    scenario.elasticity.young_modulus_Pa * units::pascal * scenario.embryo.cell_height_um}};
}

}  // namespace of_cortex

ScenarioTable cortex_table() {
  using namespace of_cortex;
  ScenarioTable info{"cortex.*", "Actomyosin cortex: thin active, elastic layer on cell faces.", "Activity"};
  const auto row = key_rows(info, &Scenario::cortices);
  info.rows = {
      row("region", &X::region, anything, "Cells with this cortex.", {.required = true}),
      row("faces", &X::faces, one_of(words::edges),
          "Faces with this cortex. A lateral face is shared by two cells and takes half of its values from each."),
      row("tension_mN_per_m", &X::tension_mN_per_m, not_negative, "Active tension of a large face (mN/m = nN/µm)."),
      row("saturation_ratio", &X::saturation_ratio, not_negative,
          "Tension saturates at small area: factor A/(A + `saturation_ratio` A₀) at area A and reference area A₀. 0: "
          "constant tension."),
      row("stiffness_mN_per_m", &X::stiffness_mN_per_m, not_negative,
          "Area elasticity: tension at doubled area (mN/m)."),
      row("compression_ratio", &X::compression_ratio, between(0, 1),
          "Stiffness in compression / in extension; 0: slack below the stress-free area."),
      row("crowding_mN_per_m", &X::crowding_mN_per_m, not_negative,
          "Area-loss resistance: compressive tension, times (A₀/A)² (mN/m)."),
      row("relaxation_s", &X::relaxation_s, positive_or_none, "Maxwell relaxation time of the stress-free area (s)."),
      row("relaxation_min", &X::relaxation_s, positive_or_none, "`relaxation_s` in minutes.",
          {.instead_of = "relaxation_s", .scale = 60}),
  };
  add_program(info.rows, row, &X::program);
  add_program(info.rows, row, &X::stiffness_program,
              {"stiffness_program.time_s", "stiffness_program.time_min", "stiffness_program.activity"});
  info.rows.insert(info.rows.end(),
                   {
                       row("trigger.measure", &X::trigger, &TriggerInput::measure, one_of(words::cell_measures),
                           "Measure that starts the time courses."),
                       row("trigger.signal", &X::trigger, &TriggerInput::signal, anything,
                           "Instead of `measure`: name of a `[signal.NAME]`."),
                       row("trigger.of", &X::trigger, &TriggerInput::of, one_of(words::read_cells),
                           "Whose: its own, or the mean of cells that share a lateral face with it."),
                       row("trigger.below", &X::trigger, &TriggerInput::below, positive, "Start below this value."),
                       row("trigger.above", &X::trigger, &TriggerInput::above, positive, "Start above this value."),
                       row("follow.measure", &X::follow, &FollowInput::measure, one_of(words::cell_measures),
                           "`[cortex.NAME]` only: measure that scales the active tension."),
                   });
  add_follow(info.rows, row);
  info.rows.insert(
      info.rows.end(),
      {
          row("direction.axis", &X::direction, &DirectionInput::axis, one_of(words::fibre_axes),
              "Axis of fibres (apical, basal), or of planar polarity by the angle a to the normal (lateral); fibres by "
              "cell, as far as it is elongated: its `long-axis`, or largest `stretch`."),
          row("direction.array", &X::direction, &DirectionInput::array, anything,
              "Apical, basal: array of angles by cell (degrees), counter-clockwise from the apical side."),
          row("direction.strongest", &X::direction, &DirectionInput::strongest, not_negative,
              "Factor along fibres, on all terms; lateral: on the tension at a = 0."),
          row("direction.weakest", &X::direction, &DirectionInput::weakest, not_negative,
              "Factor across; lateral: at a right angle; between them, by cos² a."),
          row("noise.spread", &X::noise, &WallNoiseInput::spread, between(0, 3),
              "Fluctuating tension of lateral faces: relative standard deviation of log-normal factors of "
              "mean 1, independent for each pair of cells."),
          row("noise.correlation_s", &X::noise, &WallNoiseInput::correlation_s, positive,
              "Time in which the correlation falls to 1/e (s); steps are at most a quarter of it."),
          row("noise.correlation_min", &X::noise, &WallNoiseInput::correlation_s, positive,
              "`noise.correlation_s` in minutes.", {.instead_of = "noise.correlation_s", .scale = 60}),
          row("noise.seed", &X::noise, &WallNoiseInput::seed, not_negative, "Seed of these factors."),
      });
  add_pattern(info.rows, acting(row));
  info.build = build;
  info.check = check_arrays;
  list_acting(info, &Scenario::cortices, describe, check_cortex);
  return info;
}

}  // namespace plica
