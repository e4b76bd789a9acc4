#include <fmt/format.h>

#include "app/commands.hpp"
#include "scenario/print.hpp"

namespace plica {

void add_reference_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand("reference", "print the reference of all scenario keys, in Markdown");
  command->footer("Example: plica reference > docs/scenario.md");
  command->callback([] { fmt::print("{}", reference_markdown()); });
}

}  // namespace plica
