// [embryo]: reference geometry of the cell sheet. setup.cpp builds it.
#include <fmt/ranges.h>

#include <set>

#include "scenario/embryo_axes.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_embryo {

using E = EmbryoInput;

constexpr std::int64_t max_elements = 20'000'000;

const std::vector<std::string_view> of_grid = {"pill", "sphere", "slice", "block"};  // shapes with cells on a grid
const std::vector<std::string_view> of_polygons = {"egg", "points", "sheet", "surface", "prisms"};
const std::vector<std::string_view> read_shapes = {"file", "points", "surface", "prisms"};
const std::vector<std::string_view> built = {"pill", "sphere", "slice", "block",  // shapes built by plica
                                             "egg",  "points", "sheet", "surface"};

/// Keys that the shape does not use are errors if set together with the shape or later, and dropped if inherited from
/// a scenario of another shape.
void check_unused_keys(Scenario& scenario, Input& input) {
  const std::string shape = scenario.embryo.shape;
  for (const KeyRow& row : rows_of("embryo")) {
    if (row.used_by(shape)) continue;
    const std::string address = fmt::format("embryo.{}", row.key);
    if (input.given_with(address, "embryo.shape"))
      input.report(address, fmt::format("is not used with shape \"{}\"", shape),
                   fmt::format("remove {}, or set shape to {}", row.key, fmt::join(row.options.shapes, " or ")));
    reset_to_default(row, scenario, "");
  }
  if (shape_of(scenario.embryo) == EmbryoShape::sphere) scenario.embryo.length_um = scenario.embryo.diameter_um;
}

void check_element_count(const EmbryoInput& embryo, Input& input) {
  const auto& per_cell = embryo.elements_per_cell;
  const std::int64_t elements = built_cell_count(embryo) * per_cell[0] * per_cell[1] * per_cell[2];
  if (elements > max_elements)
    input.report("embryo.cells", fmt::format("requires {} elements, more than the limit of {}", elements, max_elements),
                 "reduce cells or elements_per_cell");
}

void check_length(const std::string& address, const std::vector<double>& numbers, std::size_t length,
                  const std::string& remedy, Input& input) {
  if (numbers.size() != length && input.sound(address))
    input.report(address, fmt::format("has length {}", numbers.size()), remedy);
}

void check_embryo(Scenario& scenario, Input& input) {
  if (!input.sound("embryo.shape")) return;
  check_unused_keys(scenario, input);
  const EmbryoInput& embryo = scenario.embryo;
  const auto sound = [&](std::string_view key) { return input.sound(fmt::format("embryo.{}", key)); };
  if (is_from_file(shape_of(embryo))) {
    if (embryo.file.empty() && sound("file"))
      input.report("embryo.file", "is missing",
                   shape_of(embryo) == EmbryoShape::file ? "set file to the mesh file for shape \"file\""
                   : shape_of(embryo) == EmbryoShape::points
                       ? "set file to the table of points for shape \"points\""
                       : fmt::format("set file to the polygon file for shape \"{}\"", embryo.shape));
    check_length("embryo.scale", embryo.scale, 3, "set scale to three numbers, along x, y and z", input);
    check_length("embryo.rotate_deg", embryo.rotate_deg, 3, "set rotate_deg to three angles, about x, y and z", input);
    return;
  }
  check_length("embryo.curvature_per_um", embryo.curvature_per_um, 2,
               "set curvature_per_um to two numbers, along x and y", input);
  if (embryo.belly_sag_um.has_value() != embryo.back_sag_um.has_value())
    input.report(embryo.belly_sag_um ? "embryo.belly_sag_um" : "embryo.back_sag_um",
                 fmt::format("requires {}", embryo.belly_sag_um ? "back_sag_um" : "belly_sag_um"),
                 "set both keys, or neither");
  if ((shape_of(embryo) == EmbryoShape::pill || shape_of(embryo) == EmbryoShape::egg) && sound("length_um") &&
      sound("diameter_um") && embryo.length_um < embryo.diameter_um)
    input.report("embryo.length_um",
                 fmt::format("{} is less than the diameter, {}", embryo.length_um, embryo.diameter_um),
                 "set length_um to at least diameter_um");
  if (!is_patch(shape_of(embryo)) && sound("cell_height_um") && sound("diameter_um") &&
      embryo.cell_height_um >= embryo.diameter_um / 2)
    input.report("embryo.cell_height_um", fmt::format("{} leaves no room inside the embryo", embryo.cell_height_um),
                 fmt::format("set cell_height_um below half of diameter_um, {}", embryo.diameter_um / 2));
  if (is_of_grid(shape_of(embryo)) && sound("cells") && sound("elements_per_cell")) check_element_count(embryo, input);
}

void check_axes(const EmbryoInput& embryo, Input& input) {
  if (embryo.axes.empty() || !input.sound("embryo.axes")) return;
  if (const std::string problem = axes_problem(embryo.axes); !problem.empty())
    input.report("embryo.axes", problem, "write, for example, [\"proximal-distal\", \"anterior-posterior\", \"z\"]");
}

/// Checks a list of mirror planes or periodic directions (`key` of [embryo]): no repetition, division or projection.
/// `cells`: how messages name them.
void check_repeats(const Scenario& scenario, const std::vector<std::string>& named, const std::string& key,
                   const std::string& cells, Input& input) {
  const std::string address = "embryo." + key;
  if (std::set(named.begin(), named.end()).size() < named.size())
    return input.report(address, fmt::format("\"{}\" occurs twice", named.back()), "list each direction once");
  if (!scenario.divisions.empty())
    input.report(address, cells + " cannot divide", fmt::format("remove {}, or [division]", key));
}

void check_mirror(const Scenario& scenario, Input& input) {
  const std::string address = "embryo.mirror";
  if (scenario.embryo.mirror.empty() || !input.sound(address)) return;
  check_repeats(scenario, scenario.embryo.mirror, "mirror", "mirrored cells", input);
}

void check_periods(const Scenario& scenario, Input& input) {
  const EmbryoInput& embryo = scenario.embryo;
  const std::string address = "embryo.periodic";
  if (embryo.periodic.empty() || !input.sound(address)) return;
  check_repeats(scenario, embryo.periodic, "periodic", "cells of a periodic sheet", input);
  for (const std::string& axis : embryo.periodic)
    if (input.sound("embryo.curvature_per_um") && embryo.curvature_per_um.size() == 2 &&
        embryo.curvature_per_um[meaning_of(words::periods, axis)] != 0)
      input.report("embryo.curvature_per_um",
                   fmt::format("a sheet curved along {} cannot be periodic along {}", axis, axis),
                   fmt::format("set its curvature there to 0, or remove \"{}\" from embryo.periodic", axis));
  if (embryo.periodic.size() == words::periods.size() && meaning_of(words::rims, embryo.rim) &&
      input.sound("embryo.rim"))
    input.report("embryo.rim", "a sheet periodic along x and y has no boundary",
                 "remove rim, or one direction of embryo.periodic");
}

}  // namespace of_embryo

std::int64_t built_cell_count(const EmbryoInput& embryo) {
  using namespace of_embryo;
  const std::int64_t a = embryo.cells[0], b = embryo.cells[1], c = embryo.cells[2];
  const bool has_ends = shape_of(embryo) != EmbryoShape::slice;
  return shape_of(embryo) == EmbryoShape::block ? a * b * c : 2 * (a * b + (has_ends ? b * c : 0) + c * a);
}

ScenarioTable embryo_table() {
  using namespace of_embryo;
  ScenarioTable info{"embryo", "Reference geometry of the cell sheet.", "Geometry"};
  const auto row = key_rows("embryo", &Scenario::embryo);
  info.rows = {
      row("shape", &E::shape, one_of(words::embryo_shapes),
          "Closed embryos: `pill` (spherocylinder), `sphere`, `egg` (polygonal cells), `points` (polygonal cells "
          "around measured points). `slice`: plane-strain cross-section of a long embryo. `block`: cuboid. `sheet`: "
          "open sheet of polygonal cells. `surface`: one cell per polygon of a file. `prisms`: cells between apical "
          "and "
          "basal polygons of a file. `file`: hexahedral mesh."),
      row("length_um", &E::length_um, positive, "Length along x (µm).",
          {.shapes = {"pill", "slice", "block", "egg", "sheet"}}),
      row("diameter_um", &E::diameter_um, positive, "Outer diameter (µm).",
          {.shapes = {"pill", "sphere", "slice", "egg"}}),
      row("width_um", &E::width_um, positive, "Width along y (µm).", {.shapes = {"block", "sheet"}}),
      row("cell_height_um", &E::cell_height_um, positive, "Cell height, basal to apical (µm).", {.shapes = built}),
      row("cells", &E::cells, between(1, max_count),
          "Cells along x (axis), y (ventral side) and z (ventral to dorsal). A slice has them on four sides: `[1, 20, "
          "20]` is 80 cells.",
          {.shapes = of_grid}),
      row("elements_per_cell", &E::elements_per_cell, between(1, 16),
          "Elements per cell along x, across, and basal to apical.",
          {.shapes = {"pill", "sphere", "slice", "block", "file"}}),
      row("cell_count", &E::cell_count, between(12, max_count), "Number of cells.", {.shapes = {"egg", "sheet"}}),
      row("seed", &E::seed, between(0, 1e9), "Random seed of the cell arrangement.", {.shapes = {"egg", "sheet"}}),
      row("curvature_per_um", &E::curvature_per_um, anything,
          "Curvature along x and y (1/µm); positive: apical side outside. `[0.005, 0]` is a cylinder, `[0.005, 0.005]` "
          "a dome, `[0.005, -0.005]` a saddle.",
          {.shapes = {"sheet"}}),
      row("rim", &E::rim, one_of(words::rims), "Sheet boundary: outer lateral faces free or fixed.",
          {.shapes = {"sheet", "surface", "prisms"}}),
      row("periodic", &E::periodic, one_of(words::periods),
          "Periodic directions, with fixed length and no curvature: cells at opposite ends are neighbours.",
          {.may_be_empty = true, .shapes = {"sheet"}}),
      row("belly_sag_um", &E::belly_sag_um, positive,
          "Ventral bulge beyond the chord from 20 to 80 % of the length (µm). Requires `back_sag_um`; without both, an "
          "ellipsoid.",
          {.shapes = {"egg"}}),
      row("back_sag_um", &E::back_sag_um, positive, "Dorsal bulge (µm), likewise.", {.shapes = {"egg"}}),
      row("elements", &E::elements, one_of(words::polygon_splits),
          "Hexahedra in the prism over a polygon: split by diagonals, or one kite per corner (three times as many).",
          {.shapes = of_polygons}),
      row("least_edge_ratio", &E::least_edge_ratio, between(0, 0.5),
          "Apical edges shorter than this fraction of the mean are lengthened; 0: none.", {.shapes = of_polygons}),
      row("layers", &E::layers, between(1, 16), "Elements from basal to apical.", {.shapes = of_polygons}),
      row("points_depth_um", &E::points_depth_um, not_negative,
          "Depth of the points below the apical surface (µm), before `scale`.", {.shapes = {"points"}}),
      row("scale", &E::scale, positive, "Factors on measured x, y and z: shrinkage by fixation, or units.",
          {.shapes = read_shapes}),
      row("rotate_deg", &E::rotate_deg, between(-360, 360), "Rotation about x, then y, then z (°), after `scale`.",
          {.shapes = read_shapes}),
      row("centre", &E::centre, anything,
          "Move the centre to the origin, after `rotate_deg`: of the surface, of the volume, or the mean of points.",
          {.shapes = read_shapes}),
      row("keep", &E::keep, one_of(words::keeps),
          "Separate pieces of the file: `all`, or only the `largest`. A surface must be one piece.",
          {.shapes = {"surface", "file"}}),
      row("label_array", &E::label_array, anything,
          "Array of the file with the cell of each face: faces with one label form one cell, those with 0 or less "
          "none.",
          {.shapes = {"surface"}}),
      row("mend", &E::mend, anything,
          "Mesh repair: merges duplicate vertices, reorients faces, drops vertices along lateral faces, lengthens "
          "edges below `least_edge_ratio`, sharpens angles over 165°. `plica check` reports the counts. `false`: short "
          "edges stay, other defects are refused. Prisms: lengthens and sharpens only.",
          {.shapes = {"surface", "prisms"}}),
      row("cell_height_array", &E::cell_height_array, anything,
          "Array of the file with cell heights (µm); replaces `cell_height_um`.", {.shapes = {"surface"}}),
      row("mirror", &E::mirror, one_of(words::mirror_planes),
          "Symmetry planes through the centre: `\"x\"` across the axis, `\"y\"` along the midline. One side is solved, "
          "the whole is shown and measured. `[]`: none.",
          {.may_be_empty = true}),
      row("file", &E::file, anything,
          "Path relative to the scenario file. Shape `file`: hexahedral mesh. `points`: CSV table with columns `x_um`, "
          "`y_um`, `z_um`; others become cell arrays. `surface`: polygons in OBJ, OFF, PLY, VTP, VTK or tyssue HDF5. "
          "`prisms`: polygons with face arrays `cell` (number) and `is_apical` (1 or 0), the k-th corner of each basal "
          "polygon below that of the apical one.",
          {.is_path = true, .shapes = read_shapes}),
      row("cell_arrays", &E::cell_arrays, anything,
          "CSV table with a row per cell, in the order of `cell_id`: its columns become cell arrays.",
          {.is_path = true}),
      row("apical_array", &E::apical_array, anything,
          "Cell array with the index of the apical face (0 to 5, VTK order); default: the outer surface is apical.",
          {.shapes = {"file"}}),
      row("axes", &E::axes, anything,
          "Names of x, y and z in reports and pictures: `low-high`, or one word. Default: `[\"x\", \"y\", \"z\"]` for "
          "a block, sheet, points, surface or prisms, else `[\"anterior-posterior\", \"left-right\", "
          "\"ventral-dorsal\"]`. "
          "`ventral-dorsal` as z: reports describe a furrow."),
  };
  info.rules = [](Scenario& scenario, Input& input) {
    check_embryo(scenario, input);
    check_mirror(scenario, input);
    check_periods(scenario, input);
    check_axes(scenario.embryo, input);
  };
  return info;
}

}  // namespace plica
