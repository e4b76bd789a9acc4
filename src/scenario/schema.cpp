#include "scenario/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "core/clock.hpp"
#include "core/names.hpp"
#include "measure/columns.hpp"
#include "measure/monitor.hpp"
#include "scenario/rows_in.hpp"

namespace plica {
namespace {

std::vector<std::string_view> quantity_names() {
  std::vector<std::string_view> names;
  for (const QuantityInfo& info : quantities()) names.push_back(info.name);
  return names;
}

constexpr double max_count = 100000;
const std::vector<std::string_view> of_grid = {"pill", "sphere", "slice", "block"};  // shapes whose cells lie on a grid
const std::vector<std::string_view> of_polygons = {"egg", "points", "sheet", "surface"};
const std::vector<std::string_view> built = {"pill", "sphere", "slice", "block",  // that plica makes
                                             "egg",  "points", "sheet", "surface"};

using S = Scenario;

std::vector<Row> make_rows() {
  using E = EmbryoInput;
  using R = RegionInput;
  using D = DynamicsInput;
  using T = TimeInput;
  using H = HoldInput;
  using X = ExpectInput;
  using O = OutputInput;
  using V = DivisionInput;
  using M = MonitorInput;
  using K = CriterionInput;
  const RowsIn<S> top{"", [](S& scenario, const std::string&) -> S& { return scenario; }};
  const auto embryo = rows_in("embryo", &S::embryo);
  const auto region = rows_in("region.*", &S::regions);
  const auto volume = rows_in("volume", &S::volume);
  const auto vitelline = rows_in("vitelline", &S::vitelline);
  const auto dynamics = rows_in("dynamics", &S::dynamics);
  const auto hold = rows_in("hold.*", &S::holds);
  const auto division = rows_in("division.*", &S::divisions);
  const auto time = rows_in("time", &S::time);
  const auto stop = rows_in("stop", &S::stop);
  const auto criterion = rows_in("stop.*", &S::criteria);
  const auto monitor = rows_in("monitor.*", &S::monitors);
  const auto furrow = rows_in("furrow", &S::furrow);
  const auto output = rows_in("output", &S::output);
  const auto expect = rows_in("expect.*", &S::expect);
  std::vector<Row> rows = {
      top("format", &S::format, between(1, 1), "Version of this format."),
      top("title", &S::title, anything, "One line for reports."),
      {"", "base", [](S&, const std::string&) -> Slot { return std::monostate(); }, anything,
       "Built-in name, or path relative to this file, of the scenario to inherit from key by key. Not inherited is "
       "what a new `embryo.shape` has no use for: keys of `[embryo]`, and `face` or `array` of a region that is given "
       "another selector."},

      embryo("shape", &E::shape, one_of(words::embryo_shapes),
             "Closed sheets (pill, sphere); a ring of cells from the middle of an endless embryo (slice: plane strain, "
             "nodes move across the axis only); a block of cells; an egg of polygonal cells; polygonal cells about "
             "measured points, of a sheet, or from a file with a polygon a cell (surface); or a mesh of hexahedra "
             "(file)."),
      embryo("length_um", &E::length_um, positive, "Length along x (µm).",
             {.shapes = {"pill", "slice", "block", "egg", "sheet"}}),
      embryo("diameter_um", &E::diameter_um, positive, "Outer diameter (µm).",
             {.shapes = {"pill", "sphere", "slice", "egg"}}),
      embryo("width_um", &E::width_um, positive, "Width along y (µm).", {.shapes = {"block", "sheet"}}),
      embryo("cell_height_um", &E::cell_height_um, positive, "Height of a cell from basal to apical (µm).",
             {.shapes = built}),
      embryo(
          "cells", &E::cells, between(1, max_count),
          "Number of cells along the axis (x), across the belly (y), belly to back (z). A ring of a slice has those of "
          "belly, back and both sides: `[1, 20, 20]` is 80 cells.",
          {.shapes = of_grid}),
      embryo("elements_per_cell", &E::elements_per_cell, between(1, 16),
             "Elements of a cell along, across, basal to apical: refines the elements, not the cells.",
             {.shapes = {"pill", "sphere", "slice", "block", "file"}}),
      embryo("cell_count", &E::cell_count, between(12, max_count), "Number of cells.", {.shapes = {"egg", "sheet"}}),
      embryo("seed", &E::seed, between(0, 1e9), "How the cells are spread: another number, other cells.",
             {.shapes = {"egg", "sheet"}}),
      embryo(
          "curvature_per_um", &E::curvature_per_um, anything,
          "How a sheet is bent along x and y (1/µm): one over the radius, positive where the apical side is outside, "
          "as on an embryo. `[0.005, 0]` is part of a cylinder, `[0.005, 0.005]` a dome, `[0.005, -0.005]` a "
          "saddle.",
          {.shapes = {"sheet"}}),
      embryo("rim", &E::rim, one_of(words::rims), "Whether the outer walls of the cells at the rim are held in place.",
             {.shapes = {"sheet", "surface"}}),
      embryo("periodic", &E::periodic, one_of(words::periods),
             "Directions along which a sheet repeats itself, so that it has no rim there: cells at one end are the "
             "neighbours of those at the other. Its length along them is fixed, and it is not bent along them.",
             {.may_be_empty = true, .shapes = {"sheet"}}),
      embryo("belly_sag_um", &E::belly_sag_um, positive,
             "How far the belly's outline bulges beyond its chord from 20 to 80 % of the length (µm); goes with "
             "`back_sag_um`. Without both, an ellipsoid.",
             {.shapes = {"egg"}}),
      embryo("back_sag_um", &E::back_sag_um, positive, "The same of the back (µm).", {.shapes = {"egg"}}),
      embryo(
          "elements", &E::elements, one_of(words::polygon_splits),
          "How the prism over a polygon is made of hexahedra: by diagonals of the polygon, or a kite a corner, which "
          "takes three times as many.",
          {.shapes = of_polygons}),
      embryo("least_edge_ratio", &E::least_edge_ratio, between(0, 0.5),
             "Apical edges that are shorter, over the mean of all, are lengthened: their cells would bear little. 0: "
             "none.",
             {.shapes = of_polygons}),
      embryo("layers", &E::layers, between(1, 16), "Elements from basal to apical.", {.shapes = of_polygons}),
      embryo("points_depth_um", &E::points_depth_um, not_negative,
             "How far below the apical surface the points lie (µm, as measured).", {.shapes = {"points"}}),
      embryo("scale", &E::scale, positive,
             "Factors along x, y, z on what was measured: fixed embryos have shrunk, files are in other units.",
             {.shapes = {"points", "surface"}}),
      embryo("centre", &E::centre, anything, "Moves the middle of the surface to the origin, after `scale`.",
             {.shapes = {"surface"}}),
      embryo(
          "mend", &E::mend, anything,
          "Mends what can be mended safely: vertices that are given twice, faces that wind the other way, vertices "
          "along a wall between two cells, edges under `least_edge_ratio`, angles over 165°. `plica check` tells how "
          "many. "
          "`false`: such a surface is refused, and short edges stay.",
          {.shapes = {"surface"}}),
      embryo("cell_height_array", &E::cell_height_array, anything,
             "Array of the file with each cell's height (µm), in place of `cell_height_um`.", {.shapes = {"surface"}}),
      embryo("mirror", &E::mirror, one_of(words::mirror_planes),
             "The embryo is symmetric about these planes through its middle, `\"x\"` across the axis and `\"y\"` along "
             "the midline: one side is solved, at less cost, and the whole shown and measured. `[]`: no planes.",
             {.may_be_empty = true}),
      embryo(
          "file", &E::file, anything,
          "Path relative to the scenario's file: a hexahedral mesh; of shape points, a table in CSV whose first line "
          "names its columns, `x_um`, `y_um` and `z_um` and any others, which become arrays; of shape surface, "
          "polygons in OBJ, OFF, PLY, VTP, VTK or tyssue's HDF5.",
          {.is_path = true, .shapes = {"file", "points", "surface"}}),
      embryo("apical_array", &E::apical_array, anything,
             "Cell array of the file with the apical face (0 to 5, VTK's order) of each cell; without it the outer "
             "surface is apical.",
             {.shapes = {"file"}}),

      region("face", &R::face, one_of(words::sides), "Cells of this side of a built embryo."),
      region("cells_along", &R::cells_along, between(1, max_count),
             "Only a centred strip of the face, this many cells along (x; y on the end faces)."),
      region("cells_across", &R::cells_across, between(1, max_count),
             "Only a centred strip of the face, this many cells across (y; z on the side and end faces)."),
      region("ids", &R::ids, not_negative, "Cells by number, from 0."),
      region("array", &R::array, anything,
             "Array of the file: cells where it is not 0, or as `above` and `below` say."),
      region("above", &R::above, anything, "Where the array is above this."),
      region("below", &R::below, anything, "Where the array is below this."),
      region(
          "angle_deg", &R::angle_deg, anything,
          "Cells whose centre at rest lies at these angles about the axis, from -180 to 180: 0 at the belly, 90 on the "
          "right."),
      region("length_percent", &R::length_percent, between(0, 100),
             "Cells whose centre at rest lies in this part of the length, from the anterior end."),
      region("x_um", &R::x_um, anything,
             "Cells whose centre at rest lies in this range of x (µm); 0 is the middle of a built embryo, in y and z "
             "too."),
      region("y_um", &R::y_um, anything, "The same in y (µm)."),
      region("z_um", &R::z_um, anything, "The same in z (µm)."),
      region("rows", &R::rows, between(1, max_count),
             "Cells of the rows about the midline of the belly, at most so many, both sides together. A cell's row is "
             "how many cells one passes from the midline to it, from wall to wall."),
      region("neighbours_of", &R::neighbours_of, anything,
             "Cells that share a wall with a cell of this region and are not in it."),
      region("rings", &R::rings, between(1, 1000), "With `neighbours_of`: up to how many walls away; without it 1."),
      region("union", &R::unite, anything, "Cells of any of these regions."),
      region("intersect", &R::intersect, anything, "Only cells of each of these regions."),
      region("except", &R::except, anything, "No cells of these regions."),

      volume("method", &VolumeInput::method, one_of(words::volume_methods),
             "How cells keep their volume: as constraints of each step; by the paper's projection after it, so that "
             "the state of rest depends on the step; or not."),
      volume("projection_surface", &VolumeInput::projection_surface, one_of(words::projection_surfaces),
             "Closed surfaces whose volume is projected: each cell's; the one around all cells; the apical one, with "
             "the lumen inside."),
      volume("projection_weights", &VolumeInput::projection_weights, one_of(words::projection_weights),
             "How far the projection moves nodes along the volume's gradient: all alike (the paper), or each as far as "
             "its drag and mass let it, which is where the coupled solve goes as steps get short."),

      vitelline("enabled", &VitellineInput::enabled, anything,
                "A rigid shell around a closed embryo; false by default for a block, a sheet and a surface."),
      vitelline("gap_um", &VitellineInput::gap_um, not_negative,
                "Gap between the apical nodes at rest and the shell (µm)."),
      vitelline("drag_Pa_s_per_um", &VitellineInput::drag_Pa_s_per_um, not_negative,
                "Drag of the shell on apical nodes that slide along it, where they are on it (Pa s/µm); falls to none "
                "at 0.1 µm from it."),

      dynamics("surface_drag_Pa_s_per_um", &D::surface_drag_Pa_s_per_um, not_negative,
               "Drag on apical and basal faces (Pa s/µm); sets the clock."),
      dynamics("shear_viscosity_Pa_s", &D::shear_viscosity_Pa_s, not_negative,
               "Kelvin-Voigt viscosity in the cells (Pa s)."),
      dynamics("density_kg_per_m3", &D::density_kg_per_m3, not_negative,
               "Density (kg/m³): inertia, negligible in vivo."),

      hold("region", &H::region, anything, "Region whose nodes are held.", {.required = true}),
      hold("directions", &H::directions, one_of(words::axes), "Directions in which they are held."),
      hold("x_um", &H::x_um, anything, "Only nodes that lie at rest in this range of x (µm)."),
      hold("y_um", &H::y_um, anything, "The same in y (µm)."),
      hold("z_um", &H::z_um, anything, "The same in z (µm)."),

      division("region", &V::region, anything, "Region whose cells divide.", {.required = true}),
      division("at_s", &V::at_s, positive, "When all of them divide (s)."),
      division("at_min", &V::at_s, positive, "The same in minutes.", {.instead_of = "at_s", .scale = 60}),
      division("when", &V::when, one_of(words::division_triggers),
               "Instead of a time: a cell divides when its apical area, its volume, or the ratio of its longer to its "
               "shorter side passes the threshold, unless it is still growing."),
      division("threshold", &V::threshold, positive, "What has to be passed, with `when`."),
      division("plane", &V::plane, one_of(words::division_planes),
               "Apico-basal plane of the cut: across the embryo's axis, along the midline, or across the cell's longer "
               "side; it runs between the middles of opposite sides of the cell."),
      division("growth_s", &V::growth_s, not_negative, "Time in which daughters grow to their final size (s)."),
      division("growth_min", &V::growth_s, not_negative, "The same in minutes.",
               {.instead_of = "growth_s", .scale = 60}),
      division("daughter_volume_ratio", &V::daughter_volume_ratio, between(0.25, 2),
               "Final volume of a daughter over her mother's: 1 as large, 0.5 a half."),
      division("max_generation", &V::max_generation, between(1, 30),
               "Daughters of a later generation are not born; without it 1 with `when`, and no limit at a time."),

      time("step_s", &T::step_s, {.low = instant_s, .word_for_none = "adaptive"},
           "Time step (s), or chosen by its error."),
      time("first_step_s", &T::first_step_s, positive, "First adaptive step (s)."),
      time("max_step_s", &T::max_step_s, positive, "Longest adaptive step (s)."),
      time("tolerance_um", &T::tolerance_um, positive, "Error of an adaptive step, on positions (µm)."),
      time("end_s", &T::end_s, positive, "When the run ends (s)."),
      time("end_min", &T::end_s, positive, "The same in minutes.", {.instead_of = "end_s", .scale = 60}),
      time("scheme", &T::scheme, one_of(words::schemes),
           "How a step is solved: Newton's method, or one linear system by conjugate gradients (the paper)."),
      time("integrator", &T::integrator, one_of(words::integrators),
           "How rates are taken at the end of a step: to first order in time, or to second, by differences over two "
           "steps. The second goes with scheme newton, without inertia and with volumes that are not projected."),
      time("linear_solver", &T::linear_solver, one_of(words::linear_solvers),
           "How Newton's linear systems are solved: a factor of the whole system; or Krylov's method with a factor of "
           "its positive definite part, or with multigrid; automatic: by size. Results differ by less than the "
           "tolerances."),
      time("cg_tolerance", &T::cg_tolerance, {.low = 1e-14, .high = 0.1},
           "Residual of the conjugate gradients over the force (scheme linearly-implicit)."),
      time("cg_max_iterations", &T::cg_max_iterations, between(1, 1000000),
           "Conjugate gradients give up after as many iterations (scheme linearly-implicit)."),

      stop("equilibrium_speed_um_per_min", &StopInput::equilibrium_speed_um_per_min, positive,
           "Equilibrium is when all nodes are slower (µm/min)."),
      stop("at_equilibrium", &StopInput::at_equilibrium, anything,
           "Whether to stop there; false notes the time and runs on."),
      stop("combine", &StopInput::combine, one_of(words::combinations),
           "Whether any of the `[stop.NAME]` and equilibrium ends the run, or all of them together."),
      criterion("monitor", &K::monitor, anything, "The monitor that is bounded.", {.required = true}),
      criterion("above", &K::above, anything, "Met when the value is larger (unit of the monitor's column)."),
      criterion("below", &K::below, anything, "Met when the value is smaller (the same unit)."),
      criterion("over", &K::over, one_of(words::criterion_overs),
                "Met when any one of the monitor's nodes or cells is beyond the bound, or all of them are; without it, "
                "when the monitor's number is."),

      monitor("quantity", &M::quantity, one_of(quantity_names()), "What is measured.", {.required = true}),
      monitor("region", &M::region, anything, "Where: the cells of this region."),
      monitor("face", &M::face, one_of(words::monitor_faces),
              "Only nodes of this side of the cells; without it, all. The side of an area; without it, apical."),
      monitor("axis", &M::axis, one_of(words::axes), "The component along this axis; without it, the norm."),
      monitor("from", &M::from, anything,
              "Of a force: only what the cells of this region exert on the nodes, the pressures that hold their "
              "volumes included; without it, what drives the nodes."),
      monitor("over", &M::over, one_of(words::overs),
              "How the values of nodes or cells make one number; without it, their mean."),
      monitor("reference", &M::reference, anything,
              "What it is measured against, path relative to the scenario's file: the results of a run (deviation, "
              "relative_energy_norm), or a mesh (surface_distance).",
              {.is_path = true}),
      monitor("reference_at", &M::reference_at, one_of(words::reference_times),
              "Which of the run's frames; without it, the one of the same time."),
      monitor(
          "at_s", &M::at_s, not_negative,
          "When the value is taken that `summary.json` and a study's table have (s), linear between steps; without it, "
          "the last one."),
      monitor("at_min", &M::at_s, not_negative, "The same in minutes.", {.instead_of = "at_s", .scale = 60}),

      furrow("region", &FurrowInput::region, anything,
             "Contractile cells whose furrow is measured; without it the largest region that contracts."),
      furrow(
          "vce_cell", &FurrowInput::vce_cell, between(1, max_count),
          "VCE is this cell of the region's midline, counted from its ends; without it the second, if there is one."),

      output("frame_every_s", &O::frame_every_s, not_negative,
             "Time between frames (s); 0: only the first and the last."),
      output("frame_every_min", &O::frame_every_s, not_negative, "The same in minutes.",
             {.instead_of = "frame_every_s", .scale = 60}),
      output("cells_csv", &O::cells_csv, anything, "Whether to write cells.csv; without it, up to 2000 cells."),

      expect("value", &X::value, anything, "What is expected.", {.required = true}),
      expect("within", &X::within, not_negative, "How far off it may be, in its own unit."),
      expect("within_percent", &X::within_percent, not_negative, "The same in percent of the value.",
             {.instead_of = "within"}),
  };
  std::ranges::move(law_rows(), std::back_inserter(rows));
  return rows;
}

template <class Table>
auto names_in(Named<Table> tables) {
  return [=](const Scenario& scenario) { return keys_of(scenario.*tables); };
}

}  // namespace

bool Allowed::contains(double value) const {
  return (low_included ? value >= low : value > low) && (high_included ? value <= high : value < high);
}

const Row* row_of_key(std::string_view dotted) {
  // What is left of a key behind its first part.
  const auto behind = [](std::string_view key) {
    const std::size_t dot = key.find('.');
    return dot == std::string_view::npos ? std::string_view() : key.substr(dot + 1);
  };
  for (const Row& row : schema()) {
    const std::size_t star = row.table.find(".*");
    const std::string_view stem = row.table.substr(0, star);
    std::string_view key = dotted;
    if (!stem.empty() && !key.starts_with(std::string(stem) + '.')) continue;
    if (!stem.empty()) key = behind(key);
    if (star != std::string_view::npos) key = behind(key);
    if (key == row.key) return &row;
  }
  return nullptr;
}

std::string Allowed::text() const {
  if (!words.empty()) return fmt::format("{}", fmt::join(words, " | "));
  const double infinity = std::numeric_limits<double>::infinity();
  std::string range;
  if (low == high) {
    range = fmt::format("{}", low);
  } else if (low > -infinity && high < infinity && low_included && high_included) {
    range = fmt::format("{} to {}", low, high);
  } else {
    if (low > -infinity) range = fmt::format("{} {}", low_included ? ">=" : ">", low);
    if (high < infinity)
      range += fmt::format("{}{} {}", range.empty() ? "" : " and ", high_included ? "<=" : "<", high);
  }
  return word_for_none.empty() ? range : fmt::format("{} or \"{}\"", range, word_for_none);
}

std::string Row::type() const {
  Scenario scratch;
  const Slot slot = field(scratch, "name");
  const bool has_words = !allowed.words.empty();
  if (std::holds_alternative<int*>(slot) || std::holds_alternative<std::optional<int>*>(slot)) return "integer";
  if (std::holds_alternative<double*>(slot) || std::holds_alternative<std::optional<double>*>(slot)) return "number";
  if (std::holds_alternative<bool*>(slot) || std::holds_alternative<std::optional<bool>*>(slot)) return "true or false";
  if (std::holds_alternative<std::optional<Range>*>(slot)) return "[low, high]";
  if (std::holds_alternative<std::array<int, 3>*>(slot)) return "3 integers";
  if (std::holds_alternative<std::vector<int>*>(slot)) return "list of integers";
  if (std::holds_alternative<std::vector<double>*>(slot)) return "list of numbers";
  if (std::holds_alternative<std::vector<std::string>*>(slot)) return has_words ? "list of words" : "list of texts";
  return has_words ? "word" : "text";
}

std::string Row::expected() const {
  const std::string type = this->type();
  const std::string range = allowed.text();
  if (type == "word") return "one of: " + range;
  if (type == "list of words") return "a list of: " + range;
  const bool plain = type == "text" || type == "true or false" || type == "[low, high]" || type == "3 integers";
  std::string noun = plain ? type : (type == "integer" ? "an " : "a ") + type;
  if (range.empty()) return noun;
  return noun + (range.front() == '>' || range.front() == '<' ? " " : ", ") + range;
}

bool Row::used_by(std::string_view shape) const {
  return options.shapes.empty() || std::ranges::find(options.shapes, shape) != options.shapes.end();
}

std::span<const Row> schema() {
  static const std::vector<Row> rows = make_rows();
  return rows;
}

std::span<const TableInfo> schema_tables() {
  static const std::vector<TableInfo> tables = {
      {"", "At the top of the file.", {}},
      {"embryo", "The sheet of cells at rest.", {}},
      {"region.*",
       "A named set of cells. Selectors that are given are intersected; `all` always exists and is every cell.",
       names_in(&S::regions)},
      {"elasticity", "The elastic law of the cells.", {}},
      {"elasticity.*",
       "What cells of a region, or a layer of them, have instead; no two such tables are about the same.",
       names_in(&S::region_elasticities)},
      {"volume", "How cells keep their volume.", {}},
      {"vitelline", "The shell around the embryo.", {}},
      {"dynamics", "What resists motion; drag and density cannot both be 0.", {}},
      {"contraction.*", "Springs on edges of the cells of a region.", names_in(&S::contractions)},
      {"cortex.*",
       "A thin, active, elastic layer on faces of the cells of a region: its tension is the same in all directions.",
       names_in(&S::cortices)},
      {"enclosed.*", "A volume inside the sheet of cells, such as the yolk's.", names_in(&S::enclosed)},
      {"self_contact", "What keeps the sheet from passing through itself.", {}},
      {"hold.*", "Nodes of a region fixed in given directions.", names_in(&S::holds)},
      {"pressure.*", "A pressure on faces of a region.", names_in(&S::pressures)},
      {"ablation.*",
       "Cells of a region lose the strength of their cortices and contractions at a time: cut by a laser, or switched "
       "off by light.",
       names_in(&S::ablations)},
      {"division.*",
       "Cells of a region divide, at a time or when they pass a threshold. Cells begin as one element each.",
       names_in(&S::divisions)},
      {"time", "Steps and end.", {}},
      {"stop", "When a run is over before its end.", {}},
      {"stop.*", "A bound on a monitor that ends the run, checked after each step.", names_in(&S::criteria)},
      {"monitor.*",
       "One number a step, in `series.csv` under `NAME.quantity_unit`, the last in `summary.json`; see "
       "[measures.md](measures.md).",
       names_in(&S::monitors)},
      {"furrow", "What is measured as the furrow.", {}},
      {"output", "What a run writes.", {}},
      {"expect.*",
       "Checked at the end, exit status 1 when missed: `NAME = { value = 28.89, within_percent = 5 }`. What a built-in "
       "expects holds for the built-in as it is: it is not inherited through `base`, nor checked after `--set`. A "
       "monitor is named as in `summary.json`: `floor.position_um = { ... }`.",
       names_in(&S::expect)},
  };
  return tables;
}

std::vector<const Row*> rows_of(std::string_view table) {
  std::vector<const Row*> found;
  for (const Row& row : schema()) {
    if (row.table == table) found.push_back(&row);
  }
  return found;
}

std::span<const std::string_view> expectation_names() {
  // The measures, and what else summary.json says of a run in numbers that do not depend on the machine.
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Column* column : summary_columns()) all.push_back(column->name);
    all.insert(all.end(), {"equilibrium_time_s", "time_s", "cells", "nodes"});
    return all;
  }();
  return names;
}

void reset_to_default(const Row& row, Scenario& scenario, const std::string& name) {
  Scenario defaults;
  const Slot from = row.field(defaults, name);
  const Slot to = row.field(scenario, name);
  std::visit(
      [&](auto target) {
        if constexpr (!std::is_same_v<decltype(target), std::monostate>) *target = *std::get<decltype(target)>(from);
      },
      to);
}

}  // namespace plica
