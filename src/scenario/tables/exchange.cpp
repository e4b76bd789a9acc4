// [exchange]: cells that exchange neighbours. The rule that a simulation follows is made in simulation/controls.cpp.
#include "tissue/exchange.hpp"

#include "scenario/tables/table.hpp"

namespace plica {
namespace of_exchange {

using X = ExchangeInput;

// Laws that know no exchange.
void check_laws(const Scenario& scenario, Input& input) {
  const auto refuse = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(key)) input.report(key, problem + " beside [exchange]", remedy + ", or remove [exchange]");
  };
  if (model_of(scenario.elasticity) != ElasticModel::neo_hookean)
    refuse("elasticity.model", fmt::format("\"{}\" has no rule for new shapes", scenario.elasticity.model),
           "set model to \"neo-hookean\"");
  if (!scenario.contractions.empty())
    refuse("contraction." + scenario.contractions.begin()->first, "springs along edges are not possible",
           "use [cortex.NAME], whose faces follow");
  if (!scenario.pressures.empty())
    refuse("pressure." + scenario.pressures.begin()->first, "loads on reference faces are not possible",
           "remove the table");
  for (const auto& [name, cortex] : scenario.cortices) {
    const std::string table = "cortex." + name;
    if (!cortex.trigger.measure.empty() || !cortex.follow.measure.empty())
      refuse(table + (cortex.follow.measure.empty() ? ".trigger" : ".follow"),
             "activation by the shape of cells, whose reference changes, is not possible", "use a program");
    if (cortex.faces == "lateral" && cortex.stiffness_mN_per_m > 0 && !cortex.relaxation_s)
      refuse(table + ".relaxation_s", "new lateral faces have no stress-free area without relaxation",
             "set relaxation_min, for example to 1");
  }
}

void check_exchange(Scenario& scenario, Input& input) {
  ExchangeInput& exchange = scenario.exchange;
  for (const char* key : {"", ".below_um", ".new_length_um"})
    if (!input.sound(std::string("exchange") + key)) return;
  if (!exchange.below_um) {
    if (input.place("exchange") != nullptr && input.place("exchange.below_um") == nullptr)
      input.report("exchange.below_um", "is missing",
                   "set below_um to the length at which lateral faces turn, such as 0.35");
    return;
  }
  if (!exchange.new_length_um) exchange.new_length_um = 1.7 * *exchange.below_um;
  if (*exchange.new_length_um <= *exchange.below_um)
    input.report("exchange.new_length_um", fmt::format("{} is not above below_um", *exchange.new_length_um),
                 "set it to about 1.7 times below_um, or faces turn back");
  if (!scenario.embryo.mirror.empty() && input.sound("embryo.mirror"))
    input.report("embryo.mirror", "mirror planes are not possible beside [exchange]", "remove mirror");
  check_laws(scenario, input);
}

void check_cells(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (!scenario.exchange.below_um) return;
  if (const auto why = why_unturnable(tissue))
    errors.push_back(diagnostic_at(scenario, "exchange", "the cells of this embryo cannot exchange neighbours: " + *why,
                                   "use one layer of polygons, as of shape \"sheet\" or \"egg\", with embryo.elements "
                                   "\"diagonals\""));
}

}  // namespace of_exchange

ScenarioTable exchange_table() {
  using namespace of_exchange;
  ScenarioTable info{"exchange", "Exchange of neighbours (T1): short lateral faces turn by a quarter.", "Activity"};
  const auto row = key_rows("exchange", &Scenario::exchange);
  info.rows = {
      row("below_um", &X::below_um, positive_or_none,
          "Length, mean of base and apex, below which a lateral face turns if it shrinks and forces would lengthen the "
          "new one (µm)."),
      row("new_length_um", &X::new_length_um, positive, "Length of the new face (µm); default 1.7 times `below_um`."),
      row("again_after_s", &X::again_after_s, not_negative,
          "Time after which a face that has turned, or that forces did not open, may turn (s)."),
      row("region", &X::region, anything, "Cells that exchange neighbours."),
  };
  info.rules = check_exchange;
  info.check = check_cells;
  info.regions = [](const Scenario& scenario, const TakeRegion& take) {
    take("exchange.region", scenario.exchange.region);
  };
  return info;
}

}  // namespace plica
