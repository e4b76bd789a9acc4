#include <fmt/format.h>

#include <memory>

#include "app/commands.hpp"
#include "app/scenario_options.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "scenario/setup.hpp"
#include "scenario/watch.hpp"

namespace plica {

void add_check_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("check", "validate a scenario; print it with every default filled in");
  auto options = std::make_shared<ScenarioOptions>();
  options->add_to(*command);
  command->footer("Example: plica check my.toml --set embryo.elements_per_cell=[2,2,2]");
  command->callback([options] {
    const Scenario scenario = options->load();
    const auto model = make_model(scenario);
    (void)make_watch(scenario, model->tissue);
    (void)make_furrow_sites(scenario, model->tissue);
    (void)make_solved_side(scenario, *model);
    fmt::print("{}", resolved_toml(scenario));
    for (const std::string& line : advice(scenario, *model)) fmt::print(stderr, "{}\n", line);
  });
}

}  // namespace plica
