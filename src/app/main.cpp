#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iterator>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "app/commands.hpp"
#include "core/errors.hpp"
#include "core/memory.hpp"
#include "core/version.hpp"
#include "scenario/suggest.hpp"

namespace plica {
namespace {

// Name the nearest command or option to one that does not exist; CLI11 only misses another.
std::string unknown_word(const CLI::App& app, const std::vector<std::string>& words) {
  const auto commands = [](const CLI::App& of) {
    std::vector<std::string> names;
    for (const CLI::App* one : of.get_subcommands({})) names.push_back(one->get_name());
    return names;
  };
  const CLI::App* command = &app;
  for (const std::string& word : words) {
    if (const std::vector<std::string> names = commands(*command); std::ranges::count(names, word) > 0) {
      command = command->get_subcommand(word);
    } else if (command == &app && !word.starts_with('-')) {
      return fmt::format("unknown command \"{}\"; {}", word, did_you_mean(word, names));
    } else if (word.starts_with("--") && word.size() > 2) {
      const std::string given = word.substr(2, word.find('=') - 2);
      std::vector<std::string> known;
      for (const CLI::Option* option : command->get_options())
        std::ranges::copy(option->get_lnames(), std::back_inserter(known));
      const std::optional<std::string> nearest = nearest_name(given, known);
      if (std::ranges::count(known, given) == 0 && nearest)
        return fmt::format("unknown option --{}; use --{} (nearest match)", given, *nearest);
    }
  }
  return "";
}

int failed(ExitStatus status, const std::string& why) {
  fmt::print(stderr, "plica: {}\n", why);
  return status;
}

int refuse(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_word(app, words);
  if (unknown.empty()) return app.exit(error) == 0 ? exit_done : exit_usage;
  return failed(exit_usage, printable(unknown));
}

}  // namespace
}  // namespace plica

int main(int argc, char** argv) {
  using namespace plica;
  keep_freed_memory();
  // A reader that goes away (`plica check ... | head`) is an error of writing, not a reason to die.
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // likewise a file that reaches its limit
  CLI::App app("plica simulates how a sheet of living cells folds.\nStart with: plica run drosophila --out results");
  app.name("plica");
  app.set_version_flag("--version", fmt::format("plica {} ({}, {})", version(), commit(), compiler()));
  app.require_subcommand(1);
  int status = exit_done;
  for (AddCommand* add :
       {add_run_command, add_compare_command, add_calibrate_command, add_study_command, add_reproduce_command,
        add_report_command, add_render_command, add_export_command, add_check_command, add_mesh_command,
        add_scenarios_command, add_reference_command, add_studio_command, add_labels_command})
    add(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error, {argv + 1, argv + argc});
  } catch (const ScenarioError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return exit_usage;
  } catch (const UsageError& error) {
    return failed(exit_usage, printable(error.what()));
  } catch (const FileError& error) {
    return failed(exit_files, printable(error.what()));
  } catch (const std::system_error& error) {  // fmt::print to a full disk or a closed pipe
    return failed(exit_files, "standard output cannot be written: " + error.code().message());
  } catch (const std::bad_alloc&) {
    return failed(exit_gave_up, "out of memory; use fewer cells, or fewer elements per cell");
  } catch (const std::exception& error) {
    return failed(exit_gave_up, error.what());
  }
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  return failed(exit_files, "standard output cannot be written");
}
