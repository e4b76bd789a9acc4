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

int refuse(const CLI::App& app, const CLI::ParseError& error, const std::vector<std::string>& words) {
  const std::string unknown = error.get_exit_code() == 0 ? "" : unknown_word(app, words);
  if (unknown.empty()) return app.exit(error) == 0 ? exit_done : exit_usage;
  fmt::print(stderr, "plica: {}\n", printable(unknown));
  return exit_usage;
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
  add_run_command(app, status);
  add_compare_command(app, status);
  add_calibrate_command(app, status);
  add_study_command(app, status);
  add_reproduce_command(app, status);
  add_report_command(app, status);
  add_render_command(app, status);
  add_export_command(app, status);
  add_check_command(app, status);
  add_mesh_command(app, status);
  add_scenarios_command(app, status);
  add_reference_command(app, status);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error, {argv + 1, argv + argc});
  } catch (const ScenarioError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return exit_usage;
  } catch (const UsageError& error) {
    fmt::print(stderr, "plica: {}\n", printable(error.what()));
    return exit_usage;
  } catch (const FileError& error) {
    fmt::print(stderr, "plica: {}\n", printable(error.what()));
    return exit_files;
  } catch (const std::system_error& error) {  // fmt::print to a full disk or a closed pipe
    fmt::print(stderr, "plica: standard output cannot be written: {}\n", error.code().message());
    return exit_files;
  } catch (const std::bad_alloc&) {
    fmt::print(stderr, "plica: out of memory; use fewer cells, or fewer elements per cell\n");
    return exit_gave_up;
  } catch (const std::exception& error) {
    fmt::print(stderr, "plica: {}\n", error.what());
    return exit_gave_up;
  }
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
    fmt::print(stderr, "plica: standard output cannot be written\n");
    return exit_files;
  }
  return status;
}
