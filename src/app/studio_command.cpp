// plica studio: the Python module plica.studio, started in this program's place.
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/python_module.hpp"

namespace plica {

void add_studio_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("studio", "paint, fold, cut and compare a tissue on a local page (Python)");
  auto options = std::make_shared<std::vector<std::string>>();
  command->add_option("SCENARIO", *options, "scenario, or folder to start in; options of python -m plica.studio");
  command->allow_extras();
  command->footer("Needs pip install 'plica[studio]'.\nExample: plica studio furrow-slice");
  command->callback([command, options, &status] {
    std::vector<std::string> arguments = *options;
    for (const std::string& more : command->remaining()) arguments.push_back(more);
    status = become_module("studio", "plica.studio", arguments, "plica[studio]");
  });
}

}  // namespace plica
