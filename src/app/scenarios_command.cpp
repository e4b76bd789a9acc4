#include <fmt/format.h>

#include "app/commands.hpp"
#include "scenario/builtin.hpp"
#include "scenario/load.hpp"

namespace plica {

void add_scenarios_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("scenarios", "list the built-in scenarios");
  command->footer("Example: plica scenarios");
  command->callback([] {
    for (const BuiltinScenario& builtin : builtin_scenarios()) {
      const std::string name(builtin.name);
      fmt::print("{:<20} {}\n", name, load_scenario(find_scenario(name)).title);
    }
  });
}

}  // namespace plica
