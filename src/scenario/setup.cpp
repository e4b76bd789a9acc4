#include "scenario/setup.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <functional>
#include <iterator>
#include <set>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/measure_set.hpp"
#include "mechanics/constraints/ties.hpp"
#include "mechanics/obstacles/shell_drag.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "mechanics/surroundings.hpp"
#include "scenario/acting.hpp"
#include "scenario/builtin.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/schema.hpp"
#include "scenario/words.hpp"
#include "tissue/faces.hpp"
#include "tissue/files/points_file.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/files/prism_file.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"
#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace plica {
namespace {

Placement placement_of(const EmbryoInput& e) {
  return {Vec3(e.scale[0], e.scale[1], e.scale[2]), Vec3(e.rotate_deg[0], e.rotate_deg[1], e.rotate_deg[2]), e.centre};
}

Tissue read_tissue(const Scenario& scenario) {
  const EmbryoInput& embryo = scenario.embryo;
  try {
    const MeshOptions options{embryo.elements_per_cell, placement_of(embryo), meaning_of(words::keeps, embryo.keep)};
    Tissue tissue = embryo.mesh ? tissue_from_mesh(*embryo.mesh, options)
                                : read_mesh_file(embryo.file, embryo.apical_array, options);
    if (scenario.vitelline.enabled) tissue.outer_shape = enclosing_capsule(tissue.rest_positions);
    return tissue;
  } catch (const MeshError& error) {
    throw_at(scenario, "embryo.file", error.what(), "");
  }
}

PointTable table_of(const std::string& file) {
  if (!is_builtin_table(file)) return read_points_file(file);
  std::vector<std::string> names;
  for (const BuiltinTable& table : builtin_tables()) {
    names.push_back(fmt::format("{}{}", builtin_table_mark, table.name));
    if (names.back() == file) return points_in_csv(table.csv);
  }
  throw MeshError("table {} does not exist; use one of: {}", file, fmt::join(names, ", "));
}

PolygonCells cells_of(const EmbryoInput& e) { return {e.cell_height_um, split_of(e), e.layers, e.least_edge_ratio}; }

Tissue polygonal_tissue(const Scenario& scenario) {
  const EmbryoInput& e = scenario.embryo;
  const PolygonCells cells = cells_of(e);
  try {
    if (shape_of(e) == EmbryoShape::egg)
      return build_egg({e.length_um, e.diameter_um, e.diameter_um, e.belly_sag_um, e.back_sag_um}, e.cell_count, e.seed,
                       cells);
    if (shape_of(e) == EmbryoShape::sheet) {
      SheetShape sheet{e.length_um, e.width_um, {e.curvature_per_um[0], e.curvature_per_um[1]}};
      for (const std::string& axis : e.periodic) sheet.is_periodic[meaning_of(words::periods, axis)] = true;
      return build_sheet(sheet, e.cell_count, e.seed, cells);
    }
    const PointTable table = table_of(e.file);
    Tissue tissue = build_about_points({table.points, e.points_depth_um, placement_of(e)}, cells);
    tissue.cell_arrays.insert(table.arrays.begin(), table.arrays.end());
    tissue.remarks.insert(tissue.remarks.end(), table.remarks.begin(), table.remarks.end());
    return tissue;
  } catch (const FileError& error) {
    throw_at(scenario, is_from_file(shape_of(e)) ? "embryo.file" : "embryo", error.what(), "");
  }
}

std::vector<double> heights_of(const Scenario& scenario, const PolygonFile& file) {
  const std::string& name = scenario.embryo.cell_height_array;
  if (name.empty()) return {};
  if (const auto found = file.arrays.find(name); found != file.arrays.end()) {
    const auto missing = std::ranges::find_if(found->second, [](double height) { return std::isnan(height); });
    if (missing == found->second.end()) return found->second;
    throw_at(scenario, "embryo.cell_height_array",
             fmt::format("array \"{}\" has no value in face {}", name, missing - found->second.begin()),
             "provide a height for every face");
  }
  const std::string remedy =
      file.arrays.empty() ? "remove cell_height_array, since the file has none"
                          : fmt::format("set cell_height_array to one of: {}", fmt::join(keys_of(file.arrays), ", "));
  throw_at(scenario, "embryo.cell_height_array", fmt::format("the file has no array \"{}\"", name), remedy);
}

Tissue fitting_shell(const Scenario& scenario, SurfaceTissue result) {
  if (scenario.vitelline.enabled && !result.tissue.outer_shape)
    throw_at(scenario, "vitelline.enabled", "no vitelline membrane fits: " + result.why_no_shape,
             "set enabled to false");
  return std::move(result.tissue);
}

PolygonFile polygons_of_file(const Scenario& scenario) try {
  return read_polygon_file(scenario.embryo.file);
} catch (const FileError& error) {
  throw_at(scenario, "embryo.file", error.what(), "");
}

Tissue surface_tissue(const Scenario& scenario) {
  const EmbryoInput& e = scenario.embryo;
  PolygonFile file = polygons_of_file(scenario);
  const std::string advice = e.label_array.empty() ? label_advice(file) : "";
  SurfaceTissue result;
  try {
    if (!e.label_array.empty()) file = cells_of_labels(file, e.label_array);
    result = build_under_surface(
        {file.surface, heights_of(scenario, file), placement_of(e), e.mend, meaning_of(words::keeps, e.keep)},
        cells_of(e));
  } catch (const MeshError& error) {
    throw_at(scenario, "embryo.file",
             fmt::format("{}: {}{}{}", e.file, error.what(), advice.empty() ? "" : "; ", advice), "");
  }
  if (!advice.empty()) file.remarks.push_back(advice);
  for (const auto& [name, values] : file.arrays) result.tissue.cell_arrays[name] = of_kept(values, result.kept);
  result.tissue.remarks.insert(result.tissue.remarks.begin(), file.remarks.begin(), file.remarks.end());
  return fitting_shell(scenario, std::move(result));
}

Tissue prism_tissue(const Scenario& scenario) {
  const EmbryoInput& e = scenario.embryo;
  const PolygonFile file = e.prisms ? PolygonFile() : polygons_of_file(scenario);
  try {
    GivenPrisms prisms = e.prisms ? *e.prisms : prisms_in(file);
    return fitting_shell(scenario, build_prisms(std::move(prisms), placement_of(e), e.mend, cells_of(e)));
  } catch (const MeshError& error) {
    throw_at(scenario, "embryo.file", fmt::format("{}: {}", e.file, error.what()), "");
  }
}

Tissue build_tissue(const Scenario& scenario) {
  const EmbryoInput& e = scenario.embryo;
  switch (shape_of(e)) {
    case EmbryoShape::pill:
      return build_shell({e.length_um, e.diameter_um, e.cell_height_um, e.cells, e.elements_per_cell});
    case EmbryoShape::sphere:
      return build_shell({e.diameter_um, e.diameter_um, e.cell_height_um, e.cells, e.elements_per_cell});
    case EmbryoShape::slice:
      return build_slice({e.length_um, e.diameter_um, e.cell_height_um, e.cells, e.elements_per_cell});
    case EmbryoShape::block:
      return build_block({e.length_um, e.width_um, e.cell_height_um, e.cells, e.elements_per_cell});
    case EmbryoShape::egg:
    case EmbryoShape::points:
    case EmbryoShape::sheet:
      return polygonal_tissue(scenario);
    case EmbryoShape::surface:
      return surface_tissue(scenario);
    case EmbryoShape::prisms:
      return prism_tissue(scenario);
    case EmbryoShape::file:
      break;
  }
  return read_tissue(scenario);
}

/// Adds arrays given per cell, by a table or by a program, to those of the tissue's own file.
void add_arrays(const Scenario& scenario, Tissue& tissue) {
  const auto add = [&](const auto& arrays, const std::string& whose) {
    for (const auto& [name, values] : arrays)
      if (values.size() != tissue.cells.size())
        throw_at(scenario, "embryo.cell_arrays",
                 fmt::format("{} {} values for {} cells", whose, values.size(), tissue.cells.size()),
                 "give one per cell, in the order of cell_id; `plica mesh` writes the cells with their positions");
      else
        tissue.cell_arrays[name] = values;
  };
  const std::string& file = scenario.embryo.cell_arrays;
  try {
    if (!file.empty()) add(read_cell_table(file), file + " has");
  } catch (const FileError& error) {
    throw_at(scenario, "embryo.cell_arrays", error.what(), "");
  }
  add(scenario.embryo.arrays, "an array given has");
}

/// Imposes plane strain: no motion along the axis, and all cross-sections move alike.
void make_endless(const Scenario& scenario, Model& model) {
  for (std::array<bool, 3>& held : model.held) held[0] = true;
  const double stiffness = 1000 * model.stiffness_scale * scenario.embryo.length_um;
  model.laws.push_back(std::make_unique<Ties>(ties_along_x(model.tissue), stiffness));
}

/// Fixes nodes of lateral faces at the sheet boundary.
void hold_rim(Model& model) {
  for (const Face& face : faces_of(model.tissue, CellSide::lateral))
    if (!face.beyond && face.share == 1)
      for (const NodeId node : face.nodes)
        for (int axis = 0; axis < 3; ++axis) hold_node(node, axis, model);
}

void hold_mirror_planes(Model& model) {
  for (std::size_t n = 0; n < model.held.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.tissue.is_mirrored[axis] && model.tissue.rest_positions[n][axis] == 0) model.held[n][axis] = true;
}

/// Rejects forces that overflow in the reference state.
void check_forces_at_rest(const Scenario& scenario, const Model& model) {
  const Vectors forces = driving_forces(model, rest_state(model));
  const auto bad = std::ranges::find_if(forces, [](const Vec3& force) { return !force.allFinite(); });
  if (bad == forces.end()) return;
  const NodeId node(static_cast<std::size_t>(bad - forces.begin()));
  const auto holds_it = [&](const auto& nodes) { return std::ranges::find(nodes, node) != nodes.end(); };
  const auto element = std::ranges::find_if(model.tissue.elements, holds_it) - model.tissue.elements.begin();
  const std::string key = scenario.contractions.empty() ? "elasticity" : "contraction";
  throw_at(scenario, key,
           fmt::format("the force in cell {} is not finite in the reference state",
                       model.tissue.element_cell[static_cast<std::size_t>(element)].number()),
           "reduce stiffness, pre-tension or pressure");
}

void add_mechanics(const Scenario& scenario, const Origin& origin, Model& model) {
  const Tissue& tissue = model.tissue;
  model.volumes.hold(method_of(scenario.volume) == VolumeMethod::coupled);
  for (const ScenarioTable& table : scenario_tables())
    if (table.build) table.build(scenario, origin, model);
  if (scenario.dynamics.surface_drag_Pa_s_per_um > 0)
    model.laws.push_back(std::make_unique<SurfaceDrag>(
        tissue, scenario.dynamics.surface_drag_Pa_s_per_um * units::pascal_second_per_um));
  if (scenario.dynamics.density_kg_per_m3 > 0)
    model.laws.push_back(
        std::make_unique<Inertia>(tissue, scenario.dynamics.density_kg_per_m3 * units::kilogram_per_cubic_metre));

  if (shape_of(scenario.embryo) == EmbryoShape::slice) make_endless(scenario, model);
  if (meaning_of(words::rims, scenario.embryo.rim)) hold_rim(model);
  if (scenario.vitelline.enabled) {
    const OuterShape shell = tissue.outer_shape->moved_out(scenario.vitelline.gap_um);
    model.obstacles.push_back(std::make_unique<Vitelline>(tissue, shell));
    if (scenario.vitelline.drag_Pa_s_per_um > 0)
      model.laws.push_back(std::make_unique<ShellDrag>(
          tissue, shell, scenario.vitelline.drag_Pa_s_per_um * units::pascal_second_per_um));
  }
  check_forces_at_rest(scenario, model);
}

bool is_closed(const Scenario& scenario) try {
  const Tissue tissue = make_tissue(scenario);
  return encloses(tissue, tissue.apical_facets);
} catch (const std::exception&) {
  return true;  // no tissue: the reason comes where it is made
}

void open_reference(const MonitorInput& input, Monitor& monitor) {
  const Quantity::Reference kind = monitor.quantity->reference;
  if (kind == Quantity::Reference::run) {
    const auto at = meaning_of(words::reference_times, input.reference_at, Monitor::ReferenceAt::same_time);
    monitor.reference_run = std::make_shared<ReferenceRun>(input.reference);
    if (at == Monitor::ReferenceAt::end) monitor.reference_frame = monitor.reference_run->last_frame();
  }
  if (kind == Quantity::Reference::surface)
    monitor.reference_surface = std::make_shared<SurfaceDistance>(read_surface(input.reference));
}

Monitor make_monitor(const std::string& name, const MonitorInput& input, const Scenario& scenario) {
  Monitor monitor;
  monitor.name = name;
  monitor.quantity = quantity_named(input.quantity);
  monitor.region = input.region;
  monitor.from = input.from;
  if (!input.face.empty()) monitor.face = meaning_of(words::surfaces, input.face);
  if (!input.axis.empty()) monitor.axis = meaning_of(words::axes, input.axis);
  monitor.over = meaning_of(words::overs, input.over, monitor.over);
  monitor.at_s = input.at_s;
  monitor.poisson_ratio = scenario.elasticity.poisson_ratio;
  open_reference(input, monitor);
  return monitor;
}

bool reads_something(const Monitor& monitor, const Tissue& tissue) {
  return monitor.quantity->of == Quantity::Of::node ? !monitored_nodes(monitor, tissue).empty()
                                                    : !monitored_cells(monitor, tissue).empty();
}

StopRule make_stop_rule(const Scenario& scenario) {
  StopRule rule;
  rule.all = meaning_of(words::combinations, scenario.stop.combine);
  rule.needs_rest = scenario.stop.at_equilibrium;
  for (const auto& [name, input] : scenario.criteria) {
    Criterion criterion;
    criterion.name = name;
    const auto monitor = scenario.monitors.find(input.monitor);
    criterion.monitor = static_cast<std::size_t>(std::distance(scenario.monitors.begin(), monitor));
    criterion.above = input.above;
    criterion.below = input.below;
    criterion.over = meaning_of(words::criterion_overs, input.over, criterion.over);
    rule.criteria.push_back(std::move(criterion));
  }
  return rule;
}

void begin_sets(const Scenario& scenario, const Model& model, KeptBySet& kept, std::vector<Diagnostic>& errors) {
  // Places of a furrow do not follow cells that leave.
  FurrowSites sites;
  if (scenario.extrusions.empty()) sites = make_furrow_sites(scenario, model.tissue);
  const Subject subject{model,
                        std::move(sites),
                        have_furrow(axes_of(scenario.embryo)),
                        method_of(scenario.volume) == VolumeMethod::projection,
                        scenario.exchange.below_um,
                        scenario.exchange.region};
  const auto is_given = [&](std::string_view name) { return std::ranges::count(scenario.measure.sets, name) > 0; };
  for (const MeasureSet& set : measure_sets()) {
    const bool is_usual = is_given("automatic") && set.is_usual(subject);
    if ((is_given(set.name) || is_usual) && !begin(set, subject, kept) && is_given(set.name))
      errors.push_back(diagnostic_at(scenario, "measure.sets",
                                     fmt::format("\"{}\" has nothing to measure without {}", set.name, set.needs),
                                     "remove it, or supply what it needs"));
  }
  for (const Column& column : columns())
    if (scenario.expect.contains(std::string(column.name)) && !column.set.empty() && !kept.contains(column.set))
      errors.push_back(
          diagnostic_at(scenario, fmt::format("expect.{}", column.name), "is not measured", set_remedy(column.name)));
}

}  // namespace

void hold_node(NodeId node, int axis, Model& model) {
  for (const NodeId one : {node, model.tissue.original(node)}) model.held[one.index()][axis] = true;
}

Tissue make_tissue(const Scenario& scenario) {
  Tissue tissue = build_tissue(scenario);
  add_arrays(scenario, tissue);
  std::vector<Diagnostic> errors;
  check_rest_shape(scenario, tissue, errors);
  add_regions(scenario, tissue, errors);
  if (!errors.empty()) throw ScenarioError(std::move(errors));
  return tissue;
}

std::unique_ptr<Model> make_model(const Scenario& scenario) {
  auto model = std::make_unique<Model>(make_tissue(scenario));
  check_tissue(scenario, model->tissue);
  add_mechanics(scenario, {model->tissue, Mirror()}, *model);
  return model;
}

std::optional<SolvedSide> make_solved_side(const Scenario& scenario, const Model& whole) {
  if (scenario.embryo.mirror.empty()) return std::nullopt;
  MirroredSide side = mirrored_side(scenario, whole.tissue);
  SolvedSide solved{std::make_unique<Model>(std::move(side.tissue)), std::move(side.mirror)};
  add_mechanics(scenario, {whole.tissue, solved.mirror}, *solved.model);
  hold_mirror_planes(*solved.model);
  return solved;
}

std::vector<std::string> contracting_regions(const Scenario& scenario, const Tissue& tissue) {
  std::set<std::string> names;
  for (const Acting& acting : acting_tables(scenario))
    if (acting.contracts) names.insert(acting.input.region);
  std::vector<std::string> regions(names.begin(), names.end());
  std::ranges::stable_sort(regions, std::greater(), [&](const std::string& region) {
    return std::ranges::count(tissue.regions.at(region), true);
  });
  return regions;
}

FurrowSites make_furrow_sites(const Scenario& scenario, const Tissue& tissue) {
  std::string region = scenario.furrow.region;
  const std::vector<std::string> contracting = contracting_regions(scenario, tissue);
  if (region.empty() && !contracting.empty()) region = contracting.front();
  if (region.empty()) return choose_furrow_sites(tissue, CellSet(tissue.cells.size(), false), 1);
  FurrowSites sites = choose_furrow_sites(tissue, tissue.regions.at(region), scenario.furrow.vce_cell.value_or(2));
  if (scenario.furrow.vce_cell > sites.midline_pairs && sites.midline_pairs > 0)
    throw_at(scenario, "furrow.vce_cell",
             fmt::format("the midline of region \"{}\" has only {} cells from an end to the middle", region,
                         sites.midline_pairs),
             "reduce vce_cell; 1 is the last cell");
  return sites;
}

void set_default_shell(Scenario& scenario) {
  if (shape_of(scenario.embryo) != EmbryoShape::file || scenario.given_at.contains("vitelline.enabled")) return;
  scenario.vitelline.enabled = is_closed(scenario);
  if (scenario.vitelline.enabled) return;
  if (scenario.vitelline.drag_Pa_s_per_um > 0)
    throw_at(scenario, "vitelline.drag_Pa_s_per_um",
             "is not used without a vitelline membrane, and an open tissue has none by default",
             "remove drag_Pa_s_per_um, or set vitelline.enabled to true");
}

MeasurePlan make_measure_plan(const Scenario& scenario, const Model& model) {
  MeasurePlan plan;
  std::vector<Diagnostic> errors;
  begin_sets(scenario, model, plan.sets, errors);
  const Tissue& tissue = model.tissue;
  for (const auto& [name, input] : scenario.monitors) {
    const std::string path = "monitor." + name;
    try {
      plan.monitors.push_back(make_monitor(name, input, scenario));
      if (!reads_something(plan.monitors.back(), tissue))
        errors.push_back(diagnostic_at(scenario, path + ".face",
                                       fmt::format("no cell of region \"{}\" has this face", input.region),
                                       "change region or face"));
    } catch (const FileError& error) {
      errors.push_back(diagnostic_at(scenario, path + ".reference", error.what(), "set reference to another file"));
    }
  }
  if (!errors.empty()) throw ScenarioError(std::move(errors));
  plan.stop = make_stop_rule(scenario);
  return plan;
}

}  // namespace plica
