#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numeric>

#include "app/commands.hpp"
#include "app/output_file.hpp"
#include "app/scenario_options.hpp"
#include "core/errors.hpp"
#include "record/mesh_writer.hpp"
#include "scenario/setup.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

// How many cells have how many, as a line: "corners   5: 26 %  6: 49 %".
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
  for (const std::string& remark : tissue.remarks) fmt::print("{}\n", remark);
}

}  // namespace

void add_mesh_command(CLI::App& app, int&) {
  CLI::App* command =
      app.add_subcommand("mesh", "write the mesh at rest with its regions; print how even its cells are");
  auto options = std::make_shared<ScenarioOptions>();
  auto out = std::make_shared<std::string>();
  auto overwrite = std::make_shared<bool>(false);
  options->add_to(*command);
  command->add_option("--out,--output,-o", *out, "FILE.vtu to write")->required();
  command->add_flag("--overwrite", *overwrite, "replace FILE.vtu where it is there");
  command->footer("Example: plica mesh drosophila --out rest.vtu");
  command->callback([options, out, overwrite] {
    if (!out->ends_with(".vtu")) throw UsageError("--out " + *out + ": the file's name must end in .vtu");
    require_free(*out, *overwrite);
    const Tissue tissue = make_tissue(options->load());
    MeshArrays arrays;
    std::vector<int> ids;
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) ids.push_back(static_cast<int>(c));
    arrays.cell_integers.emplace_back("cell_id", ids);
    const CellGroups groups = groups_of(tissue);
    for (const auto& [name, list] : {std::pair("elements_per_cell", groups.elements_per_cell),
                                     {"cell_corner_counts", groups.corner_counts},
                                     {"cell_corners", groups.corners},
                                     {"hanging_nodes", groups.hanging}})
      if (!list.empty()) arrays.lists.emplace_back(name, list);
    for (const auto& [name, values] : tissue.cell_arrays)
      if (name != "cell_id" && !(name.starts_with("region_") && tissue.regions.contains(name.substr(7))))
        arrays.cell_scalars.emplace_back(name, values);
    for (const auto& [name, cells] : tissue.regions)
      arrays.cell_integers.emplace_back("region_" + name, std::vector<int>(cells.begin(), cells.end()));
    write_mesh(*out, tissue, tissue.rest_positions, arrays);
    print_quality(tissue);
  });
}

}  // namespace plica
