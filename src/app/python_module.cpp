#include "app/python_module.hpp"

#include <unistd.h>

#include <filesystem>

#include "core/child_process.hpp"
#include "core/errors.hpp"

namespace plica {

int become_module(const std::string& command, const std::string& module, const std::vector<std::string>& words,
                  const std::string& to_install) {
  std::error_code error;
  const auto beside = std::filesystem::read_symlink("/proc/self/exe", error).parent_path() / "python3";
  const std::string python = std::filesystem::exists(beside, error) ? beside.string() : "python3";
  const std::string package = module.substr(0, module.find('.'));
  // Is it there? To import it would take as long as its start.
  if (run_command({python, "-c", "import importlib.util; exit(not importlib.util.find_spec('" + package + "'))"})
          .status)
    throw UsageError(command + ": needs the Python package of plica, which " + python +
                     " does not find; pip install '" + to_install + "'");
  std::vector<std::string> all = {python, "-m", module};
  all.insert(all.end(), words.begin(), words.end());
  return become(all, STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace plica
