// plica labels: the command labels of the Python package, started in this program's place.
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/python_module.hpp"

namespace plica {

void add_labels_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("labels", "make cells of a volume of labels (Python)");
  command->prefix_command();  // all words are the package's
  command->footer(
      "Needs pip install 'plica[image]'.\n"
      "Options (FILE --help explains them):\n"
      "  --out --spacing-um --apical --background --gap-px --keep-cut --keep --picture --overwrite\n"
      "Example: plica labels cyst.tif --spacing-um 1 0.3 0.3 --apical inside --out cells.vtp --picture cells.png");
  command->callback([command, &status] {
    std::vector<std::string> words = {"labels"};
    for (const std::string& word : command->remaining()) words.push_back(word);
    status = become_module("labels", "plica", words, "plica[image]");
  });
}

}  // namespace plica
