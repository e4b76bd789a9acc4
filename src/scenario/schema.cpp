#include "scenario/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "core/clock.hpp"
#include "core/names.hpp"
#include "measure/measure_set.hpp"
#include "measure/monitor.hpp"
#include "scenario/rows_in.hpp"

namespace plica {
namespace {

std::vector<std::string_view> quantity_names() {
  std::vector<std::string_view> names;
  for (const QuantityInfo& info : quantities()) names.push_back(info.name);
  return names;
}

std::vector<std::string_view> set_names() {
  std::vector<std::string_view> names = {"automatic"};
  for (const MeasureSet& set : measure_sets())
    if (!set.name.empty()) names.push_back(set.name);
  return names;
}

constexpr double max_count = 100000;
const std::vector<std::string_view> of_grid = {"pill", "sphere", "slice", "block"};  // shapes with cells on a grid
const std::vector<std::string_view> of_polygons = {"egg", "points", "sheet", "surface"};
const std::vector<std::string_view> of_file = {"file", "points", "surface"};
const std::vector<std::string_view> built = {"pill", "sphere", "slice", "block",  // shapes built by plica
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
  const auto measure = rows_in("measure", &S::measure);
  const auto furrow = rows_in("furrow", &S::furrow);
  const auto output = rows_in("output", &S::output);
  const auto expect = rows_in("expect.*", &S::expect);
  std::vector<Row> rows = {
      top("format", &S::format, between(1, 1), "Version of the file format."),
      top("title", &S::title, anything, "One line for reports."),
      {"", "base", [](S&, const std::string&) -> Slot { return std::monostate(); }, anything,
       "Scenario to inherit from, key by key: built-in name, or path relative to this file. A new `embryo.shape` drops "
       "inherited `[embryo]` keys it does not use; a new region selector drops an inherited `face` or `array` that the "
       "shape lacks."},

      embryo("shape", &E::shape, one_of(words::embryo_shapes),
             "Closed embryos: `pill` (spherocylinder), `sphere`, `egg` (polygonal cells), `points` (polygonal cells "
             "around measured points). `slice`: plane-strain cross-section of a long embryo. `block`: cuboid. `sheet`: "
             "open sheet of polygonal cells. `surface`: one cell per polygon of a file. `file`: hexahedral mesh."),
      embryo("length_um", &E::length_um, positive, "Length along x (µm).",
             {.shapes = {"pill", "slice", "block", "egg", "sheet"}}),
      embryo("diameter_um", &E::diameter_um, positive, "Outer diameter (µm).",
             {.shapes = {"pill", "sphere", "slice", "egg"}}),
      embryo("width_um", &E::width_um, positive, "Width along y (µm).", {.shapes = {"block", "sheet"}}),
      embryo("cell_height_um", &E::cell_height_um, positive, "Cell height, basal to apical (µm).", {.shapes = built}),
      embryo("cells", &E::cells, between(1, max_count),
             "Cells along x (axis), y (ventral side) and z (ventral to dorsal). A slice has them on four sides: `[1, "
             "20, 20]` is 80 cells.",
             {.shapes = of_grid}),
      embryo("elements_per_cell", &E::elements_per_cell, between(1, 16),
             "Elements per cell along x, across, and basal to apical.",
             {.shapes = {"pill", "sphere", "slice", "block", "file"}}),
      embryo("cell_count", &E::cell_count, between(12, max_count), "Number of cells.", {.shapes = {"egg", "sheet"}}),
      embryo("seed", &E::seed, between(0, 1e9), "Random seed of the cell arrangement.", {.shapes = {"egg", "sheet"}}),
      embryo("curvature_per_um", &E::curvature_per_um, anything,
             "Curvature along x and y (1/µm); positive: apical side outside. `[0.005, 0]` is a cylinder, `[0.005, "
             "0.005]` a dome, `[0.005, -0.005]` a saddle.",
             {.shapes = {"sheet"}}),
      embryo("rim", &E::rim, one_of(words::rims), "Sheet boundary: outer lateral faces free or fixed.",
             {.shapes = {"sheet", "surface"}}),
      embryo("periodic", &E::periodic, one_of(words::periods),
             "Periodic directions, with fixed length and no curvature: cells at opposite ends are neighbours.",
             {.may_be_empty = true, .shapes = {"sheet"}}),
      embryo("belly_sag_um", &E::belly_sag_um, positive,
             "Ventral bulge beyond the chord from 20 to 80 % of the length (µm). Requires `back_sag_um`; without both, "
             "an ellipsoid.",
             {.shapes = {"egg"}}),
      embryo("back_sag_um", &E::back_sag_um, positive, "Dorsal bulge (µm), likewise.", {.shapes = {"egg"}}),
      embryo("elements", &E::elements, one_of(words::polygon_splits),
             "Hexahedra in the prism over a polygon: split by diagonals, or one kite per corner (three times as many).",
             {.shapes = of_polygons}),
      embryo("least_edge_ratio", &E::least_edge_ratio, between(0, 0.5),
             "Apical edges shorter than this fraction of the mean are lengthened; 0: none.", {.shapes = of_polygons}),
      embryo("layers", &E::layers, between(1, 16), "Elements from basal to apical.", {.shapes = of_polygons}),
      embryo("points_depth_um", &E::points_depth_um, not_negative,
             "Depth of the points below the apical surface (µm), before `scale`.", {.shapes = {"points"}}),
      embryo("scale", &E::scale, positive, "Factors on measured x, y and z: shrinkage by fixation, or units.",
             {.shapes = of_file}),
      embryo("rotate_deg", &E::rotate_deg, between(-360, 360), "Rotation about x, then y, then z (°), after `scale`.",
             {.shapes = of_file}),
      embryo("centre", &E::centre, anything,
             "Move the centre to the origin, after `rotate_deg`: of the surface, of the volume, or the mean of points.",
             {.shapes = of_file}),
      embryo("keep", &E::keep, one_of(words::keeps),
             "Separate pieces of the file: `all`, or only the `largest`. A surface must be one piece.",
             {.shapes = {"surface", "file"}}),
      embryo("label_array", &E::label_array, anything,
             "Array of the file with the cell of each face: faces with one label form one cell, those with 0 or less "
             "none.",
             {.shapes = {"surface"}}),
      embryo("mend", &E::mend, anything,
             "Mesh repair: merges duplicate vertices, reorients faces, drops vertices along lateral faces, lengthens "
             "edges below `least_edge_ratio`, sharpens angles over 165°. `plica check` reports the counts. `false`: "
             "short edges stay, other defects are refused.",
             {.shapes = {"surface"}}),
      embryo("cell_height_array", &E::cell_height_array, anything,
             "Array of the file with cell heights (µm); replaces `cell_height_um`.", {.shapes = {"surface"}}),
      embryo("mirror", &E::mirror, one_of(words::mirror_planes),
             "Symmetry planes through the centre: `\"x\"` across the axis, `\"y\"` along the midline. One side is "
             "solved, the whole is shown and measured. `[]`: none.",
             {.may_be_empty = true}),
      embryo(
          "file", &E::file, anything,
          "Path relative to the scenario file. Shape `file`: hexahedral mesh. `points`: CSV table with columns `x_um`, "
          "`y_um`, `z_um`; others become cell arrays. `surface`: polygons in OBJ, OFF, PLY, VTP, VTK or tyssue HDF5.",
          {.is_path = true, .shapes = of_file}),
      embryo("cell_arrays", &E::cell_arrays, anything,
             "CSV table with a row per cell, in the order of `cell_id`: its columns become cell arrays.",
             {.is_path = true}),
      embryo("apical_array", &E::apical_array, anything,
             "Cell array with the index of the apical face (0 to 5, VTK order); default: the outer surface is apical.",
             {.shapes = {"file"}}),
      embryo("axes", &E::axes, anything,
             "Names of x, y and z in reports and pictures: `low-high`, or one word. Default: `[\"x\", \"y\", \"z\"]` "
             "for a "
             "block, sheet, points or surface, else `[\"anterior-posterior\", \"left-right\", \"ventral-dorsal\"]`. "
             "`ventral-dorsal` as z: reports describe a furrow."),

      region("face", &R::face, one_of(words::sides), "Side of a built embryo."),
      region("cells_along", &R::cells_along, between(1, max_count),
             "Centred strip of the face: cells along x (y on end faces)."),
      region("cells_across", &R::cells_across, between(1, max_count),
             "Centred strip of the face: cells along y (z on side and end faces)."),
      region("ids", &R::ids, not_negative, "Cell numbers, from 0."),
      region("array", &R::array, anything, "Cell array: cells where it is not 0, or lies within `above` and `below`."),
      region("above", &R::above, anything, "Lower bound of the array."),
      region("below", &R::below, anything, "Upper bound of the array."),
      region("angle_deg", &R::angle_deg, anything,
             "Angle of the cell centre about the axis, -180 to 180; 0: ventral, 90: right."),
      region("length_percent", &R::length_percent, between(0, 100),
             "Position of the cell centre along the axis (% of length), from the anterior end."),
      region("x_um", &R::x_um, anything, "x of the cell centre (µm); 0 is the centre of a built embryo."),
      region("y_um", &R::y_um, anything, "y of the cell centre (µm)."),
      region("z_um", &R::z_um, anything, "z of the cell centre (µm)."),
      region("rows", &R::rows, between(1, max_count),
             "Number of cell rows about the ventral midline, both sides together. Rows are counted through lateral "
             "faces."),
      region("neighbours_of", &R::neighbours_of, anything,
             "Cells outside this region that share a lateral face with it."),
      region("rings", &R::rings, between(1, 1000), "Width of `neighbours_of` in cells; default 1."),
      region("union", &R::unite, anything, "Cells of any of these regions."),
      region("intersect", &R::intersect, anything, "Cells of each of these regions."),
      region("except", &R::except, anything, "No cells of these regions."),

      volume("method", &VolumeInput::method, one_of(words::volume_methods),
             "`coupled`: equality constraints in each step. `projection`: the paper's projection after each step, so "
             "that the equilibrium depends on the step. `none`: not conserved."),
      volume(
          "projection_surface", &VolumeInput::projection_surface, one_of(words::projection_surfaces),
          "Surfaces whose volume is projected: of each cell, of the tissue, or the apical one with the lumen inside."),
      volume("projection_weights", &VolumeInput::projection_weights, one_of(words::projection_weights),
             "Node displacement along the volume gradient: equal (the paper), or by mobility (drag and mass), which "
             "approaches `coupled` for short steps."),

      vitelline("enabled", &VitellineInput::enabled, anything,
                "Rigid membrane around a closed embryo (unilateral constraint); default false for a block, sheet, "
                "surface, or open mesh of shape `file`."),
      vitelline("gap_um", &VitellineInput::gap_um, not_negative,
                "Perivitelline gap above the apical nodes at t = 0 (µm)."),
      vitelline("drag_Pa_s_per_um", &VitellineInput::drag_Pa_s_per_um, not_negative,
                "Viscous drag on apical nodes that slide along the membrane (Pa s/µm); 0 from 0.1 µm away."),

      dynamics("surface_drag_Pa_s_per_um", &D::surface_drag_Pa_s_per_um, not_negative,
               "Viscous drag on apical and basal faces (Pa s/µm); sets the time scale."),
      dynamics("shear_viscosity_Pa_s", &D::shear_viscosity_Pa_s, not_negative,
               "Kelvin–Voigt viscosity of cells (Pa s)."),
      dynamics("density_kg_per_m3", &D::density_kg_per_m3, not_negative,
               "Density (kg/m³): inertia, negligible in vivo."),

      hold("region", &H::region, anything, "Cells whose nodes are fixed.", {.required = true}),
      hold("directions", &H::directions, one_of(words::axes), "Fixed directions."),
      hold("x_um", &H::x_um, anything, "Only nodes with x in this range at t = 0 (µm)."),
      hold("y_um", &H::y_um, anything, "Likewise in y (µm)."),
      hold("z_um", &H::z_um, anything, "Likewise in z (µm)."),

      division("region", &V::region, anything, "Cells that divide.", {.required = true}),
      division("at_s", &V::at_s, positive, "Time of division (s)."),
      division("at_min", &V::at_s, positive, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
      division("when", &V::when, one_of(words::division_triggers),
               "Instead of a time: a cell divides when its apical area, volume or elongation (longer / shorter side) "
               "exceeds `threshold`, unless it is still growing."),
      division("threshold", &V::threshold, positive, "Threshold of `when`."),
      division("plane", &V::plane, one_of(words::division_planes),
               "Apico-basal division plane through midpoints of opposite cell sides: across the axis, along the "
               "midline, or across the longer side."),
      division("growth_s", &V::growth_s, not_negative, "Time in which daughters grow to final size (s)."),
      division("growth_min", &V::growth_s, not_negative, "`growth_s` in minutes.",
               {.instead_of = "growth_s", .scale = 60}),
      division("daughter_volume_ratio", &V::daughter_volume_ratio, between(0.25, 2),
               "Final daughter volume / mother volume."),
      division("max_generation", &V::max_generation, between(1, 30),
               "Last generation; default 1 with `when`, unlimited with a time."),

      time("step_s", &T::step_s, {.low = instant_s, .word_for_none = "adaptive"},
           "Time step (s), or adaptive by local error."),
      time("first_step_s", &T::first_step_s, positive, "First adaptive step (s)."),
      time("max_step_s", &T::max_step_s, positive, "Longest adaptive step (s)."),
      time("tolerance_um", &T::tolerance_um, positive, "Local error tolerance of an adaptive step, on positions (µm)."),
      time("end_s", &T::end_s, positive, "End of the run (s)."),
      time("end_min", &T::end_s, positive, "`end_s` in minutes.", {.instead_of = "end_s", .scale = 60}),
      time("scheme", &T::scheme, one_of(words::schemes),
           "Step solver: Newton's method, or one linear system by conjugate gradients (the paper)."),
      time("integrator", &T::integrator, one_of(words::integrators),
           "First or second order in time. `bdf2` requires scheme `newton`, no inertia and no projection. `automatic`: "
           "`bdf2` where it can be, else `backward-euler`."),
      time("linear_solver", &T::linear_solver, one_of(words::linear_solvers),
           "Linear solver in Newton's method: factorization of the whole system (`direct`), or a Krylov method with a "
           "factorization of its positive definite part (`cholesky`) or with multigrid; `automatic`: by size. Results "
           "differ by less than the tolerances."),
      time("cg_tolerance", &T::cg_tolerance, {.low = 1e-14, .high = 0.1},
           "Relative residual of conjugate gradients (`linearly-implicit`)."),
      time("cg_max_iterations", &T::cg_max_iterations, between(1, 1000000),
           "Iterations after which conjugate gradients fail (`linearly-implicit`)."),

      stop("equilibrium_speed_um_per_min", &StopInput::equilibrium_speed_um_per_min, positive,
           "Equilibrium: all nodes are slower (µm/min)."),
      stop("at_equilibrium", &StopInput::at_equilibrium, anything,
           "Stop at equilibrium; false records the time and continues."),
      stop("combine", &StopInput::combine, one_of(words::combinations),
           "Stop at any, or at all, of `[stop.NAME]` and equilibrium."),
      criterion("monitor", &K::monitor, anything, "Bounded monitor.", {.required = true}),
      criterion("above", &K::above, anything, "Met above this value (unit of the monitor's column)."),
      criterion("below", &K::below, anything, "Met below this value."),
      criterion("over", &K::over, one_of(words::criterion_overs),
                "Met if any, or all, of the monitor's nodes or cells pass the bound; default: its single value."),

      monitor("quantity", &M::quantity, one_of(quantity_names()), "Recorded quantity.", {.required = true}),
      monitor("region", &M::region, anything, "Cells measured."),
      monitor("face", &M::face, one_of(words::monitor_faces),
              "Nodes of this side only; default all. For areas: the face, default apical."),
      monitor("axis", &M::axis, one_of(words::axes), "Component; default the norm."),
      monitor("from", &M::from, anything,
              "For forces: only those exerted by cells of this region, including volume constraints; default the "
              "driving force of the nodes."),
      monitor("over", &M::over, one_of(words::overs), "Statistic over nodes or cells; default mean."),
      monitor("reference", &M::reference, anything,
              "Reference, path relative to the scenario file: run directory (deviation, relative_energy_norm) or mesh "
              "(surface_distance).",
              {.is_path = true}),
      monitor("reference_at", &M::reference_at, one_of(words::reference_times),
              "Frame of the reference run; default the same time."),
      monitor("at_s", &M::at_s, not_negative,
              "Time of the value in `summary.json` and study tables (s), interpolated; default the last."),
      monitor("at_min", &M::at_s, not_negative, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),

      measure("sets", &MeasureInput::sets, one_of(set_names()),
              "Sets of [output variables](measures.md#sets) to measure; `automatic`: those that fit the tissue.",
              {.may_be_empty = true}),

      furrow("region", &FurrowInput::region, anything,
             "Contractile cells that form the furrow; default the largest contracting region."),
      furrow("vce_cell", &FurrowInput::vce_cell, between(1, max_count),
             "Position of the near-end midline cell (VCE), counted from the ends; default 2, if present."),

      output("frame_every_s", &O::frame_every_s, not_negative,
             "Time between frames (snapshots; s); 0: first and last only."),
      output("frame_every_min", &O::frame_every_s, not_negative, "`frame_every_s` in minutes.",
             {.instead_of = "frame_every_s", .scale = 60}),
      output("cells_csv", &O::cells_csv, anything, "Write cells.csv; default up to 2000 cells."),

      expect("value", &X::value, anything, "Expected value.", {.required = true}),
      expect("within", &X::within, not_negative, "Tolerance, in the unit of the value."),
      expect("within_percent", &X::within_percent, not_negative, "Tolerance in percent of the value.",
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
  // Returns a key without its first part.
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
  std::string noun = type == "text" ? "a text" : plain ? type : (type == "integer" ? "an " : "a ") + type;
  if (range.empty()) return noun;
  return noun + (range.front() == '>' || range.front() == '<' ? " " : ", ") + range;
}

std::string Row::remedy() const { return fmt::format("set {} to {}", key.substr(key.rfind('.') + 1), expected()); }

bool Row::used_by(std::string_view shape) const {
  return options.shapes.empty() || std::ranges::find(options.shapes, shape) != options.shapes.end();
}

std::span<const Row> schema() {
  static const std::vector<Row> rows = make_rows();
  return rows;
}

std::span<const TableInfo> schema_tables() {
  static const std::vector<TableInfo> tables = {
      {"", "Keys at the top of the file.", "General", {}},
      {"embryo", "Reference geometry of the cell sheet.", "Geometry", {}},
      {"region.*", "Named cell set: cells that meet all given selectors, in the reference state. `all` is predefined.",
       "Geometry", names_in(&S::regions)},
      {"elasticity", "Constitutive law of cells.", "Passive mechanics", {}},
      {"elasticity.*",
       "Different elasticity of a region or layer; default values are those of `[elasticity]`. Tables must not "
       "overlap.",
       "Passive mechanics", names_in(&S::region_elasticities)},
      {"volume", "Conservation of cell volume.", "Passive mechanics", {}},
      {"vitelline", "Vitelline membrane.", "Surroundings", {}},
      {"dynamics", "Drag, viscosity and inertia; drag and density must not both be 0.", "Passive mechanics", {}},
      {"contraction.*", "Contractile springs on cell edges.", "Activity", names_in(&S::contractions)},
      {"cortex.*", "Actomyosin cortex: thin active, elastic layer on cell faces, with isotropic tension.", "Activity",
       names_in(&S::cortices)},
      {"enclosed.*", "Volume enclosed by the cell sheet, such as the yolk.", "Surroundings", names_in(&S::enclosed)},
      {"self_contact", "Contact of the sheet with itself.", "Surroundings", {}},
      {"hold.*", "Fixed nodes (Dirichlet condition).", "Surroundings", names_in(&S::holds)},
      {"pressure.*", "Pressure on cell faces.", "Surroundings", names_in(&S::pressures)},
      {"ablation.*", "Laser ablation or optogenetic inhibition: loss of cortical and contractile strength.", "Activity",
       names_in(&S::ablations)},
      {"division.*", "Cell division at a time or above a threshold, of cells with one element each.", "Activity",
       names_in(&S::divisions)},
      {"time", "Time steps and end of the run.", "Run", {}},
      {"stop", "Early end of a run.", "Run", {}},
      {"stop.*", "Bound on a monitor that ends the run, checked after each step.", "Run", names_in(&S::criteria)},
      {"monitor.*",
       "Probe: one value per step in `series.csv`, column `NAME.quantity_unit`; the last is in `summary.json`. See "
       "[output variables](measures.md).",
       "Output", names_in(&S::monitors)},
      {"measure", "What is measured.", "Output", {}},
      {"furrow", "Where the furrow is measured.", "Output", {}},
      {"output", "Files of a run.", "Output", {}},
      {"expect.*",
       "Checks at the end of the run; a miss gives exit status 1: `NAME = { value = 28.89, within_percent = 5 }`, or "
       "for a monitor `floor.position_um = { ... }`. Expectations of a built-in are not inherited through `base`, nor "
       "checked with `--set`.",
       "Output", names_in(&S::expect)},
  };
  return tables;
}

std::span<const InnerTables> inner_tables() {
  static const std::vector<InnerTables> tables = {
      {"Activity time course",
       {"program", "stiffness_program"},
       "Piecewise linear activity, constant before the first and after the last time. Without it, activity is 1. It "
       "scales the tension of `[contraction.NAME]`, the active tension (`program`) and stiffness (`stiffness_program`) "
       "of `[cortex.NAME]`, and the pressure of `[pressure.NAME]`."},
      {"Trigger and follow",
       {"trigger", "follow"},
       "Shape-dependent, cell-autonomous activity. `trigger` starts both time courses of a cell at a threshold; "
       "before, tension is 0 and stiffness that of time 0. `follow` multiplies the active tension by a linear function "
       "of cell shape. Shape is measured at the start of each step, relative to the reference state; `apical_stretch` "
       "is the largest stretch of the apical surface."},
      {"Profile",
       {"profile"},
       "Spatial profile: amplitude factor per cell, by distance d from the centre of the region, from `middle` at the "
       "centre to `edge` far away. Keys ending in `_deg` require axis `angle`."},
      {"Variation", {"variation"}, "Random amplitude factor per cell: log-normal with mean 1."},
      {"Delay and pulse",
       {"delay", "pulse"},
       "Activation wave, behind which cells start their time course, and pulsatile activity with the factor 1 + "
       "`amplitude` sin(2π(t/period + phase))."},
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
  // Output variables, and other machine-independent numbers of summary.json.
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Column* column : summary_columns(all_columns())) all.push_back(column->name);
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
