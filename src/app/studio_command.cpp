// plica studio: the Python module plica.studio, started in this program's place.
#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "core/child_process.hpp"
#include "core/errors.hpp"

namespace plica {
namespace {

/// Python of the environment that this program is installed in, or else of PATH.
std::string python() {
  std::error_code error;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "python3";
  return std::filesystem::exists(beside, error) ? beside.string() : "python3";
}

int studio(const std::vector<std::string>& arguments) {
  const std::string interpreter = python();
  if (run_command({interpreter, "-c", "import plica.studio"}).status != 0)
    throw UsageError("studio: needs the Python package of plica, which " + interpreter +
                     " does not find; pip install 'plica[studio]'");
  std::vector<std::string> words = {interpreter, "-m", "plica.studio"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return become(words, STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace

void add_studio_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("studio", "paint, fold, cut and compare a tissue on a local page (Python)");
  auto options = std::make_shared<std::vector<std::string>>();
  command->add_option("SCENARIO", *options, "scenario, or folder to start in; options of python -m plica.studio");
  command->allow_extras();
  command->footer("Needs pip install 'plica[studio]'.\nExample: plica studio furrow-slice");
  command->callback([command, options, &status] {
    std::vector<std::string> arguments = *options;
    for (const std::string& more : command->remaining()) arguments.push_back(more);
    status = studio(arguments);
  });
}

}  // namespace plica
