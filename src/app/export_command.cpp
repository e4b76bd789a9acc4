#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/options.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "measure/reference_run.hpp"
#include "record/polygon_surface.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

struct ExportCommand {
  std::string directory, out, time = "last", side = "apical";
  bool overwrite = false, quiet = false;
};

void write_tables(const SurfaceMesh& surface, const ExportCommand& command) {
  const fs::path directory = command.out;
  const auto [vertices, edges, faces] = tables_of(surface);
  const auto files = {std::pair("vert.csv", &vertices), {"edge.csv", &edges}, {"face.csv", &faces}};
  for (const auto& [name, text] : files) require_free((directory / name).string(), command.overwrite);
  make_directory(directory);
  for (const auto& [name, text] : files) write_file(directory / name, *text);
}

void export_frame(const ExportCommand& command) {
  const bool as_surface = command.out.ends_with(".vtp");
  if (const fs::path file = command.out; !as_surface && file.has_extension())
    throw UsageError(
        fmt::format("--out {}: neither FILE.vtp (surface) nor a directory (tables); give one of these", command.out));
  if (as_surface) require_free(command.out, command.overwrite);
  const ReferenceRun run(command.directory);
  const double time_s = snapshot_time_s(command.time, run.times_s());
  SurfaceMesh surface = surface_of(run.frame_at(time_s).value(), command.side == "apical");
  surface.time_s = time_s;
  as_surface ? write_polygons(command.out, surface) : write_tables(surface, command);
  if (!command.quiet)
    fmt::print("{}: {} polygons, {} vertices at {:.4g} s\n", command.out, surface.ends.size(), surface.points.size(),
               time_s);
}

}  // namespace

void add_export_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "export", "export a snapshot as one polygon per cell: a VTK surface, or tables for vertex models");
  auto options = std::make_shared<ExportCommand>();
  command->add_option("DIR", options->directory, "results of a run")->required();
  add_out_option(*command, options->out, "FILE.vtp to write; or directory for vert.csv, edge.csv, face.csv")
      ->required();
  command->add_option("--time", options->time, "time of the snapshot: 5min, 300s, 300 or last")->capture_default_str();
  command->add_option("--side", options->side, "surface to export")
      ->check(CLI::IsMember({"apical", "basal"}))
      ->capture_default_str();
  command->add_flag("--overwrite", options->overwrite, "replace existing files");
  command->add_flag("--quiet", options->quiet, "print only errors");
  command->footer(
      "Examples: plica export results/drosophila --out apices.vtp\n"
      "          plica export results/drosophila --time 2min --out tables");
  command->callback([options] { export_frame(*options); });
}

}  // namespace plica
