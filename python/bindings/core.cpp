// Module plica._core, the internal basis of the Python package. Not for users.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "core/errors.hpp"
#include "core/memory.hpp"
#include "core/threads.hpp"
#include "core/version.hpp"
#include "errors.hpp"
#include "record/checkpoint.hpp"
#include "record/results.hpp"
#include "scenario/advice.hpp"
#include "scenario/builtin.hpp"
#include "scenario/print.hpp"
#include "scenario/schema.hpp"
#include "scenario/setup.hpp"
#include "show/looks.hpp"
#include "signals.hpp"
#include "simulation.hpp"
#include "study/calibrate.hpp"
#include "thread_count.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/given_prisms.hpp"

namespace plica::python {
namespace {

using Numbers = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;
using Whole = nb::ndarray<const int, nb::c_contig, nb::device::cpu>;

Vectors positions_of(const Numbers& points) {
  Vectors positions;
  for (std::size_t n = 0; n < points.shape(0); ++n)
    positions.emplace_back(points.data()[3 * n], points.data()[3 * n + 1], points.data()[3 * n + 2]);
  return positions;
}

/// Make a mesh from arrays whose shapes and numbers have been checked.
std::shared_ptr<const HexahedralMesh> mesh_of(const Numbers& points, const Whole& hexahedra,
                                              const std::vector<int>& apical_faces,
                                              const std::map<std::string, std::vector<double>>& arrays,
                                              const std::vector<std::string>& remarks) {
  auto mesh = std::make_shared<HexahedralMesh>();
  mesh->points = positions_of(points);
  for (std::size_t c = 0; c < hexahedra.shape(0); ++c) {
    auto& cell = mesh->cells.emplace_back();
    for (std::size_t i = 0; i < 8; ++i) cell[i] = NodeId(hexahedra.data()[8 * c + i]);
  }
  mesh->apical_faces = apical_faces;
  for (const auto& [name, values] : arrays) mesh->arrays[name] = values;
  mesh->remarks = remarks;
  return mesh;
}

/// Make prisms from arrays that have been checked: columns of corners, and those of each cell.
std::shared_ptr<const GivenPrisms> prisms_of(const Numbers& apical, const Numbers& basal,
                                             const std::vector<std::vector<std::size_t>>& cells,
                                             const std::map<std::string, std::vector<double>>& arrays,
                                             const std::vector<std::string>& remarks) {
  return std::make_shared<const GivenPrisms>(
      GivenPrisms{{positions_of(apical), positions_of(basal), cells}, {arrays.begin(), arrays.end()}, remarks});
}

/// Return points, nodes of hexahedra and the cell of each, as made with the defaults of [embryo].
nb::tuple hexahedra_of(const std::shared_ptr<const GivenPrisms>& prisms) {
  Tissue tissue;
  {
    const nb::gil_scoped_release free;
    tissue = build_prisms(*prisms, {}, true, {}).tissue;
  }
  std::vector<double> points;
  for (const Vec3& x : tissue.rest_positions) points.insert(points.end(), x.begin(), x.end());
  std::vector<std::size_t> nodes, cells;
  for (const auto& element : tissue.elements)
    for (const NodeId node : element) nodes.push_back(node.index());
  for (const CellId cell : tissue.element_cell) cells.push_back(cell.index());
  return nb::make_tuple(points, nodes, cells);
}

CheckedScenario load(const std::string& name, const std::string& file, const std::string& text,
                     const std::vector<std::string>& overrides, const std::map<std::string, std::vector<int>>& regions,
                     const std::map<std::string, std::vector<double>>& arrays,
                     const std::shared_ptr<const HexahedralMesh>& mesh,
                     const std::shared_ptr<const GivenPrisms>& prisms) {
  CheckedScenario checked{{name, file, text}, load_scenario({name, file, text}, overrides)};
  for (const auto& [region, ids] : regions) {
    checked.scenario.regions[region] = {};
    checked.scenario.regions[region].ids = ids;
  }
  checked.scenario.embryo.arrays = arrays;
  checked.scenario.embryo.mesh = mesh;
  checked.scenario.embryo.prisms = prisms;
  set_default_shell(checked.scenario);
  return checked;
}

/// Number of cells of the embryo, whatever arrays and regions it is given.
std::size_t count_cells(const CheckedScenario& checked) {
  Scenario bare = checked.scenario;
  bare.regions.clear();
  bare.embryo.arrays.clear();
  const nb::gil_scoped_release free;
  const SafeThreadCount count(1);
  return make_tissue(bare).cells.size();
}

nb::dict calibration(const CheckedScenario& scenario, const std::vector<std::string>& overrides,
                     const std::map<std::string, std::pair<double, double>>& vary,
                     const std::map<std::string, std::pair<double, double>>& targets, int most_trials,
                     const nb::callable& on_trial) {
  CalibrationProblem problem{scenario.source, overrides, {}, {}, most_trials};
  for (const auto& [key, bounds] : vary) problem.keys.push_back({key, bounds.first, bounds.second});
  for (const auto& [name, target] : targets) problem.targets.push_back({name, target.first, target.second});
  Signals signals;
  CalibrationHooks hooks;
  hooks.stop_requested = [&] { return signals.have_come(); };
  const auto as_dict = [&](const Trial& trial) {
    nb::dict row, values, found;
    for (std::size_t k = 0; k < trial.values.size(); ++k) values[problem.keys[k].key.c_str()] = trial.values[k];
    for (std::size_t t = 0; t < trial.found.size(); ++t)
      found[problem.targets[t].name.c_str()] = trial.found[t] ? nb::cast(*trial.found[t]) : nb::none();
    row["trial"] = trial.number;
    row["values"] = values;
    row["found"] = found;
    row["failure"] = trial.failure;
    row["worst_miss"] = trial.worst_miss;
    return row;
  };
  hooks.on_trial = [&](const Trial& trial, bool best) {
    const nb::gil_scoped_acquire held;
    try {
      on_trial(as_dict(trial), best);
    } catch (nb::python_error& error) {
      signals.raise_later(std::move(error));
    }
  };
  Calibration result;
  {
    const nb::gil_scoped_release free;
    const SafeThreadCount count(threads_for(0, 0));
    result = calibrate(problem, hooks);
  }
  signals.rethrow();
  nb::dict answer;
  answer["end"] = result.end == CalibrationEnd::met       ? "met"
                  : result.end == CalibrationEnd::not_met ? "not_met"
                                                          : "trials_spent";
  answer["best"] = result.best ? nb::object(as_dict(*result.best)) : nb::none();
  return answer;
}

/// Return all tables of a scenario: path, meaning, group and rows of keys, as the reference page lists them.
nb::list schema() {
  const auto text = [](std::string_view view) { return nb::str(view.data(), view.size()); };
  const auto texts = [text](const std::vector<std::string_view>& views) {
    nb::list list;
    for (const std::string_view view : views) list.append(text(view));
    return list;
  };
  nb::list tables;
  for (const ScenarioTable& table : scenario_tables()) {
    nb::list rows;
    for (const KeyRow& key : table.rows) {
      nb::dict row;
      row["key"] = text(key.key);
      row["type"] = key.type();
      row["allowed"] = key.allowed.text();
      row["words"] = texts(key.allowed.words);
      row["meaning"] = text(key.meaning);
      row["required"] = key.options.required;
      row["is_path"] = key.options.is_path;
      row["shapes"] = texts(key.options.shapes);
      row["instead_of"] = text(key.options.instead_of);
      rows.append(row);
    }
    tables.append(nb::make_tuple(text(table.path), text(table.meaning), text(table.group), rows));
  }
  return tables;
}

/// Return the quantities that colour an embryo, with their colour scales.
nb::dict colour_fields_by_name() {
  nb::dict fields;
  for (const ColourField& field : colour_fields()) {
    nb::dict row;
    row["label"] = field.title();
    row["array"] = field.array;
    row["on_nodes"] = field.on_nodes;
    row["kind"] = field.kind == ScaleKind::from_zero ? "from_zero" : field.kind == ScaleKind::about ? "about" : "steps";
    row["centre"] = field.centre;
    std::vector<std::tuple<double, double, double>> colours;
    for (const Rgb& rgb : field.map().colours) colours.emplace_back(rgb[0], rgb[1], rgb[2]);
    row["colours"] = colours;
    fields[field.name.c_str()] = row;
  }
  return fields;
}

/// Return the views of a tissue, the default view first.
nb::dict views_by_name(const Numbers& points, const Whole& hexahedra) {
  nb::dict views;
  const auto mesh = mesh_of(points, hexahedra, {}, {}, {});
  Frame frame;
  frame.positions = mesh->points;
  frame.elements = mesh->cells;
  for (const View& view : views_of(frame)) {
    nb::dict row;
    row["sight"] = std::tuple(view.sight.x(), view.sight.y(), view.sight.z());
    row["up"] = std::tuple(view.up.x(), view.up.y(), view.up.z());
    row["cut_axis"] = view.cut_axis;
    row["cut_um"] = view.cut_um;
    views[view.name.c_str()] = row;
  }
  return views;
}

}  // namespace

NB_MODULE(_core, module) {
  keep_some_freed_memory();
  translate_errors();
  module.attr("version") = version();
  module.attr("scenarios") = [] {
    nb::dict texts;
    for (const BuiltinScenario& scenario : builtin_scenarios())
      texts[std::string(scenario.name).c_str()] = std::string(scenario.toml);
    return texts;
  }();
#ifdef PLICA_WITH_VTK
  module.attr("reads_meshes") = true;
#else
  module.attr("reads_meshes") = false;
#endif
  nb::class_<HexahedralMesh>(module, "Mesh");
  nb::class_<GivenPrisms>(module, "Prisms");
  module.def("prisms", &prisms_of, nb::arg("apical"), nb::arg("basal"), nb::arg("cells"), nb::arg("arrays"),
             nb::arg("remarks"));
  module.def("hexahedra_of", &hexahedra_of, nb::arg("prisms"));
  module.def("mesh", &mesh_of, nb::arg("points"), nb::arg("hexahedra"), nb::arg("apical_faces"), nb::arg("arrays"),
             nb::arg("remarks"));
  nb::class_<CheckedScenario>(module, "Scenario")
      .def_prop_ro("has_mesh", [](const CheckedScenario& s) { return s.scenario.embryo.mesh != nullptr; })
      .def(
          "give_mesh",
          [](CheckedScenario& s, const std::shared_ptr<const HexahedralMesh>& mesh) {
            s.scenario.embryo.mesh = mesh;
            set_default_shell(s.scenario);
          },
          nb::arg("mesh"))
      .def_prop_ro("title", [](const CheckedScenario& s) { return s.scenario.title; })
      .def_prop_ro("cell_count", &count_cells)
      .def(
          "shell",
          [](const CheckedScenario& s, const Numbers& rest_positions) -> std::optional<std::pair<double, double>> {
            const auto shell = shell_of_run(s.scenario, positions_of(rest_positions));
            if (!shell) return {};
            return std::pair(shell->half_axis_um, shell->radius_um);
          },
          nb::arg("rest_positions"))
      .def("toml", [](const CheckedScenario& s) { return resolved_toml(s.scenario); })
      .def("advice", [](const CheckedScenario& s) {
        const nb::gil_scoped_release free;
        const SafeThreadCount count(1);
        return advice(s.scenario, *make_model(s.scenario));
      });
  module.def(
      "find",
      [](const std::string& name_or_path) {
        const ScenarioSource found = find_scenario(name_or_path);
        return std::tuple(found.name, found.file, found.text);
      },
      nb::arg("name_or_path"));
  module.def("load", &load, nb::arg("name"), nb::arg("file"), nb::arg("text"), nb::arg("overrides"), nb::arg("regions"),
             nb::arg("arrays"), nb::arg("mesh").none(), nb::arg("prisms").none() = nb::none());
  module.def("calibrate", &calibration, nb::arg("scenario"), nb::arg("overrides"), nb::arg("vary"), nb::arg("targets"),
             nb::arg("most_trials"), nb::arg("on_trial"));
  module.def(
      "scenario_of_saved",
      [](const nb::bytes& saved) {
        return read_checkpoint_bytes({saved.c_str(), saved.size()}).scenario;
      },
      nb::arg("saved"));
  module.def("schema", &schema);
  module.def("colour_fields", &colour_fields_by_name);
  module.def("views", &views_by_name, nb::arg("points"), nb::arg("hexahedra"));
  module.def(
      "colour_range",
      [](const std::string& name, double smallest, double largest) {
        const auto field = std::ranges::find(colour_fields(), name, &ColourField::name);
        const ColourRange range =
            colour_range(field == colour_fields().end() ? ColourField{} : *field, smallest, largest);
        return std::pair(range.low, range.high);
      },
      nb::arg("field"), nb::arg("smallest"), nb::arg("largest"));
  bind_simulation(module);
  bind_study(module);
  bind_tapes(module);
}

}  // namespace plica::python
