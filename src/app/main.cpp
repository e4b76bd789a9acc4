#include <fmt/format.h>

#include <csignal>
#include <exception>
#include <new>
#include <system_error>

#include "app/commands.hpp"
#include "core/errors.hpp"
#include "core/memory.hpp"
#include "core/version.hpp"

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
    return app.exit(error) == 0 ? exit_done : exit_usage;
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
