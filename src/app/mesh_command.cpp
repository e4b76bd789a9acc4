#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/mesh_writer.hpp"
#include "scenario/acting.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/setup.hpp"
#include "scenario/words.hpp"
#include "show/run_pictures.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

// Print a distribution as one line: "corners   5: 26 %  6: 49 %".
void print_shares(const char* name, const std::vector<std::size_t>& counts) {
  fmt::print("{:<24}", name);
  const double all = static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0}));
  for (std::size_t n = 0; n < counts.size(); ++n)
    if (counts[n] > 0) fmt::print("  {}: {:.1f} %", n, 100 * static_cast<double>(counts[n]) / all);
  fmt::print("\n");
}

void print_quality(const Tissue& tissue) {
  const MeshQuality quality = mesh_quality(tissue, tissue.rest_positions);
  const bool has_polygons = !std::ranges::all_of(tissue.cells, &Cell::is_of_grid);
  fmt::print("{} cells, {} elements, {} nodes\n{:<24}{:>10}{:>10}{:>10}\n", tissue.cells.size(), tissue.elements.size(),
             tissue.node_count(), "", "min", "mean", "max");
  const auto row = [](const char* name, const Spread& s) {
    const int digits = s.mean >= 10 ? 1 : 3;
    fmt::print("{:<24}{:>10.{}f}{:>10.{}f}{:>10.{}f}\n", name, s.min, digits, s.mean, digits, s.max, digits);
  };
  row("cell volume, um3", quality.volume_um3);
  row("apical area, um2", quality.apical_area_um2);
  if (!has_polygons) {
    row("edge along, um", quality.along_um);
    row("edge across, um", quality.across_um);
    row("cell height, um", quality.height_um);
    fmt::print("{:<24}{:>10.3f}\n", "worst scaled Jacobian", quality.min_scaled_jacobian);
    return;
  }
  const PolygonQuality polygons = polygon_quality(tissue, tissue.rest_positions);
  row("basal area, um2", polygons.basal_area_um2);
  row("apical edge, um", polygons.apical_edge_um);
  row("cell height, um", quality.height_um);
  fmt::print("{:<24}{:>10.3f}   in cell {}\n", "worst scaled Jacobian", quality.min_scaled_jacobian,
             quality.worst_cell.number());
  print_shares("corners", polygons.corner_counts);
  print_shares("neighbours", polygons.neighbours);
  if (polygons.rim_cells > 0) fmt::print("{:<24}{:>10}\n", "cells at the rim", polygons.rim_cells);
}

struct MeshCommand {
  ScenarioOptions scenario;
  std::string out, colour = "region";
  std::vector<std::string> views;
  int threads = 0;
  bool overwrite = false;
};

void mesh(const MeshCommand& command) {
  const bool as_picture = command.out.ends_with(".png");
  require_new(command.out, {".vtu", ".png"}, command.overwrite);
  if (command.threads > 0) omp_set_num_threads(command.threads);
  const Scenario scenario = command.scenario.load();
  const Tissue tissue = [&] {
    const DelayedNotice notice;
    return make_tissue(scenario);
  }();
  const RestArrays at_rest = rest_arrays(scenario, tissue);
  const FramePolygons polygons = polygons_of(tissue);
  MeshArrays arrays;
  std::vector<int> ids;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) ids.push_back(static_cast<int>(c));
  arrays.cell_integers.emplace_back("cell_id", ids);
  for (const auto& [name, cells] : tissue.regions)
    arrays.cell_integers.emplace_back("region_" + name, std::vector<int>(cells.begin(), cells.end()));
  arrays.cell_scalars = at_rest.cells;
  arrays.element_scalars = at_rest.elements;
  arrays.polygons = &polygons;
  const CellGroups groups = groups_of(tissue);
  for (const auto& [name, list] : {std::pair("elements_per_cell", groups.elements_per_cell),
                                   {"cell_corner_counts", groups.corner_counts},
                                   {"cell_corners", groups.corners},
                                   {"hanging_nodes", groups.hanging}})
    if (!list.empty()) arrays.lists.emplace_back(name, list);
  if (as_picture)
    write_file(command.out, Painter().png(rest_picture(frame_of(tissue, tissue.rest_positions, arrays), command.colour,
                                                       command.views, axes_of(scenario.embryo))));
  else
    write_mesh(command.out, tissue, tissue.rest_positions, arrays);
  print_quality(tissue);
  for (const std::string& remark : tissue.remarks) fmt::print("{}\n", remark);
  if (const std::string doubt = unit_warning(scenario.embryo, tissue); !doubt.empty())
    fmt::print(stderr, "warning: {}\n", doubt);
}

}  // namespace

void add_mesh_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "mesh", "write the undeformed mesh with its cell data, or a picture of it; print the mesh quality");
  auto options = std::make_shared<MeshCommand>();
  options->scenario.add_to(*command);
  add_out_option(*command, options->out, "FILE.vtu to write, or FILE.png")->required();
  add_colour_option(*command, options->colour,
                    "cell array to colour by: region, strength_contraction.NAME, young_modulus_Pa, ...");
  add_view_option(*command, options->views);
  add_threads_option(*command, options->threads);
  command->add_flag("--overwrite", options->overwrite, "replace an existing file");
  command->footer(
      "Examples: plica mesh drosophila --out rest.vtu\n"
      "          plica mesh drosophila-atlas --out sna.png --color sna --view ventral");
  command->callback([options] { mesh(*options); });
}

}  // namespace plica
