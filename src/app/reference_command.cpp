#include <fmt/format.h>

#include "app/commands.hpp"
#include "measure/columns.hpp"
#include "scenario/builtin.hpp"
#include "scenario/load.hpp"
#include "scenario/print.hpp"

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

void add_reference_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("reference", "print the reference of all scenario keys in Markdown");
  const CLI::Option* measures =
      command->add_flag("--measures")->description("print the reference of all output variables instead");
  command->footer("Example: plica reference > docs/reference/scenario.md");
  command->callback([=] { fmt::print("{}", measures->count() > 0 ? measures_markdown() : reference_markdown()); });
}

}  // namespace plica
