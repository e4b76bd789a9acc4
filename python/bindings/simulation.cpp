#include "simulation.hpp"

#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>
#include <pthread.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arrays.hpp"
#include "core/threads.hpp"
#include "core/units.hpp"
#include "core/version.hpp"
#include "errors.hpp"
#include "given_energy.hpp"
#include "measure/cell_columns.hpp"
#include "measure/cells.hpp"
#include "measure/walls.hpp"
#include "mechanics/active/cell_pattern.hpp"
#include "mechanics/energy.hpp"
#include "record/checkpoint.hpp"
#include "record/time_left.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "simulation/run_warnings.hpp"
#include "thread_count.hpp"
#include "tissue/faces.hpp"

namespace plica::python {
namespace {

std::unique_ptr<Simulation> simulation_of(const Scenario& scenario, int threads, const nb::list& energies) {
  const PartsAddition add = adding_energies(energies);
  const nb::gil_scoped_release free;
  const SafeThreadCount count(threads);
  Simulation::Parts parts = parts_of(scenario);
  add(parts);
  return std::make_unique<Simulation>(std::move(parts));
}

nb::dict measures(const Simulation& simulation) {
  nb::dict result;
  const Observation& row = simulation.measures();
  const auto put = [&](const char* name, const std::optional<double>& value) {
    result[name] = value ? nb::cast(*value) : nb::none();
  };
  for (const Column* column : simulation.observer().columns())
    if (column->of_step) put(std::string(column->name).c_str(), row[*column]);
  const std::vector<Monitor>& monitors = simulation.observer().monitors();
  for (std::size_t m = 0; m < row.monitors.size(); ++m) put(monitors[m].column().c_str(), row.monitors[m]);
  return result;
}

nb::dict cell_data(const Simulation& simulation) {
  nb::dict result;
  const MeasuredCells measured(simulation.model(), simulation.state());
  for (const CellColumn& column : cell_columns())
    if (column.in_csv) result[std::string(column.name).c_str()] = array_of(column.values(measured));
  for (std::size_t s = 0; s < simulation.state().signals.size(); ++s)
    result[array_of_signal(simulation.model().signals.rules()[s].name).c_str()] =
        array_of(std::vector<double>(simulation.state().signals[s]));
  for (const auto* arrays : {&simulation.model().tissue.cell_arrays, &simulation.outside_arrays()})
    for (const auto& [name, values] : *arrays)
      if (!result.contains(name.c_str())) result[name.c_str()] = array_of(values);
  return result;
}

nb::dict concentrations(const Simulation& simulation) {
  nb::dict result;
  const State& state = simulation.state();
  for (std::size_t s = 0; s < state.signals.size(); ++s)
    result[simulation.model().signals.rules()[s].name.c_str()] = array_of(std::vector<double>(state.signals[s]));
  return result;
}

nb::dict regions(const Simulation& simulation) {
  nb::dict result;
  for (const auto& [name, cells] : simulation.model().tissue.regions) result[name.c_str()] = array_of(cells);
  return result;
}

nb::dict energies(const Simulation& simulation) {
  nb::dict result;
  const std::vector<std::string> labels = energy_labels(simulation.model());
  for (std::size_t l = 0; l < simulation.energies().size(); ++l) {
    const auto& [active, stored, dissipated] = simulation.energies()[l];
    nb::dict row;
    row["active"] = active;
    row["stored"] = stored;
    row["dissipated"] = dissipated;
    result[labels[l].c_str()] = row;
  }
  return result;
}

std::vector<std::string> laws(const Simulation& simulation, bool active_only) {
  std::vector<std::string> labels;
  for (const auto& law : simulation.model().laws)
    if (law->is_active() || !active_only) labels.push_back(law->label());
  return labels;
}

nb::object forces(const Simulation& simulation, const std::string& label) {
  const Model& model = simulation.model();
  const Law& law = *model.laws[place_of_law(model, label)];
  return array_of(std::span<const Vec3>(forces_of_law(model, simulation.state(), law)));
}

nb::object activity(const Simulation& simulation, const std::string& label) {
  const Model& model = simulation.model();
  const State& state = simulation.state();
  const std::size_t place = place_of_law(model, label, true);
  std::vector<double> result;
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
    result.push_back(
        model.laws[place]->activity_of(CellId(c), state.time_s, state.internals[place]).value_or(std::nan("")));
  return array_of(std::move(result));
}

nb::object strength(const Simulation& simulation, const std::string& label) {
  const Model& model = simulation.model();
  const CellPattern* pattern = model.laws[place_of_law(model, label, true)]->pattern();
  std::vector<double> result(model.tissue.cells.size(), 0.0);
  if (pattern != nullptr && !pattern->cells.empty())
    for (std::size_t c = 0; c < result.size(); ++c) result[c] = pattern->strengths[c];
  return array_of(std::move(result));
}

nb::object pressures_Pa(const Simulation& simulation) {
  std::vector<double> result;
  for (const double pressure : simulation.state().pressures(simulation.model()))
    result.push_back(pressure / units::pascal);
  return array_of(std::move(result));
}

nb::object neighbours(const Simulation& simulation) {
  std::vector<std::pair<int, int>> pairs;
  for (const Face& face : faces_of(simulation.model().tissue, CellSide::lateral))
    if (face.beyond) pairs.push_back(std::minmax(face.cell.number(), face.beyond->number()));
  std::ranges::sort(pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<int> numbers;
  for (const auto& [a, b] : pairs) numbers.insert(numbers.end(), {a, b});
  return array_of(std::move(numbers), 2);
}

nb::dict walls(const Simulation& simulation) {
  std::vector<int> cell, other;
  std::vector<double> length_um, area_um2, tension;
  for (const MeasuredWall& wall : measured_walls(simulation.model(), simulation.state())) {
    cell.push_back(wall.cell.number());
    other.push_back(wall.other ? wall.other->number() : -1);
    length_um.push_back(wall.length_um);
    area_um2.push_back(wall.area_um2);
    tension.push_back(wall.tension);  // 1 nN/um = 1 mN/m
  }
  nb::dict result;
  result["cell"] = array_of(std::move(cell));
  result["other"] = array_of(std::move(other));
  result["length_um"] = array_of(std::move(length_um));
  result["area_um2"] = array_of(std::move(area_um2));
  result["tension_mN_per_m"] = array_of(std::move(tension));
  return result;
}

}  // namespace

SimulationOf::Turn::Turn(SimulationOf& owner) : owner_(owner) {
  if (owner.is_busy_.exchange(true))
    throw std::runtime_error("another thread is advancing this simulation; wait for it, or use a copy()");
}

SimulationOf::SimulationOf(const CheckedScenario& scenario, int threads, std::unique_ptr<Simulation> simulation,
                           std::string at_rest)
    : scenario_(std::make_unique<CheckedScenario>(scenario)),
      simulation_(std::move(simulation)),
      threads_(threads),
      at_rest_(std::move(at_rest)) {
  simulation_->stop_when([this] { return (record_ && record_->has_failed()) || signals_.have_come(); });
}

SimulationOf::SimulationOf(const CheckedScenario& scenario, int threads, const nb::list& energies)
    : SimulationOf(scenario, threads, simulation_of(scenario.scenario, threads, energies), "") {
  threads_ = threads_for(threads, simulation_->model().tissue.elements.size());
  at_rest_ = fingerprint(simulation_->model().tissue);
}

SimulationOf::SimulationOf(const CheckedScenario& scenario, int threads, const nb::bytes& saved,
                           const nb::list& energies)
    : SimulationOf(scenario, threads, energies) {
  Checkpoint checkpoint = read_checkpoint_bytes({saved.c_str(), saved.size()});
  if (checkpoint.at_rest != at_rest_)
    throw FileError(
        "the saved state belongs to another tissue; load it with the mesh or tissue that it was saved with");
  try {
    const SafeThreadCount count(threads_);
    simulation_->go_on_from(std::move(checkpoint.run));
  } catch (const UnfitMemory& error) {
    throw FileError(std::string("the saved state is damaged: ") + error.what());
  }
}

std::unique_ptr<SimulationOf> SimulationOf::copy() {
  const Turn turn(*this);
  const SafeThreadCount count(threads_);
  return std::unique_ptr<SimulationOf>(
      new SimulationOf(*scenario_, threads_, std::make_unique<Simulation>(*simulation_), at_rest_));
}

bool SimulationOf::step(double until_s) {
  const Turn turn(*this);
  bool more = false;
  {
    const nb::gil_scoped_release free;
    const SafeThreadCount count(threads_);
    more = simulation_->step(until_s);
  }
  signals_.rethrow();
  if (!more && simulation_->status() == RunStatus::failed)
    throw GaveUp{simulation_->failure(), simulation_->failed_cell(), simulation_->time_s()};
  return more;
}

void SimulationOf::set_activity(const std::string& law, std::vector<double> activities) {
  const Turn turn(*this);
  simulation_->set_activity(law, std::move(activities));
}

void SimulationOf::set_wall_factors(const std::string& law, const std::vector<double>& factors) {
  const Turn turn(*this);
  simulation_->set_wall_factors(law, factors);
}

void SimulationOf::set_cell_array(const std::string& name, std::vector<double> values) {
  const Turn turn(*this);
  simulation_->set_cell_array(name, std::move(values));
}

void SimulationOf::set_signal(const std::string& name, std::vector<double> values) {
  const Turn turn(*this);
  simulation_->set_signal(name, std::move(values));
}

nb::bytes SimulationOf::save() {
  const Turn turn(*this);
  const std::string bytes =
      checkpoint_bytes({version(), resolved_toml(scenario_->scenario), at_rest_, simulation_->memory(), {}});
  return nb::bytes(bytes.data(), bytes.size());
}

std::vector<std::string> SimulationOf::begin_record(const std::string& out, const std::string& start) {
  const Turn turn(*this);
  const nb::gil_scoped_release free;
  auto record = std::make_unique<RecordedRun>(out, scenario_->scenario, scenario_->source, *simulation_,
                                              start == "resume"      ? RecordedRun::Start::resumed
                                              : start == "overwrite" ? RecordedRun::Start::over
                                                                     : RecordedRun::Start::fresh);
  std::vector<std::string> notes = record->notes();
  if (record->is_finished()) {
    notes.push_back(out + ": the run is already complete");
    return notes;
  }
  const SafeThreadCount count(threads_);
  record->begin();
  record_ = std::move(record);
  return notes;
}

void SimulationOf::end_record() {
  const Turn turn(*this);
  const nb::gil_scoped_release free;
  const std::unique_ptr<RecordedRun> record = std::move(record_);
  record->finish();
}

void bind_simulation(nb::module_& module) {
  pthread_atfork(nullptr, nullptr, [] { is_forked = true; });
  using S = SimulationOf;
  // Wraps a function that only reads the simulation.
  const auto looks = [](auto look) { return [look](S& self) { return self.with(look); }; };
  const auto of_state = [looks](auto member) {
    return looks([member](const Simulation& s) { return array_of(std::span<const Vec3>(s.state().*member)); });
  };
  const auto of_tissue = [looks](auto take) {
    return looks([take](const Simulation& s) { return take(s.model().tissue); });
  };
  nb::class_<TimeLeft>(module, "TimeLeft")
      .def("add", &TimeLeft::add, nb::arg("elapsed_s"), nb::arg("time_s"), nb::arg("fastest_um_per_s"))
      .def_prop_ro("text", &TimeLeft::text);
  nb::class_<S>(module, "Simulation")
      .def(nb::init<const CheckedScenario&, int, const nb::list&>(), nb::arg("scenario"), nb::arg("threads"),
           nb::arg("energies") = nb::list())
      .def(nb::init<const CheckedScenario&, int, const nb::bytes&, const nb::list&>(), nb::arg("scenario"),
           nb::arg("threads"), nb::arg("saved"), nb::arg("energies") = nb::list())
      .def("copy", &S::copy)
      .def("step", &S::step, nb::arg("until_s"))
      .def("set_activity", &S::set_activity, nb::arg("law"), nb::arg("activities"))
      .def("set_wall_factors", &S::set_wall_factors, nb::arg("law"), nb::arg("factors"))
      .def("set_cell_array", &S::set_cell_array, nb::arg("name"), nb::arg("values"))
      .def("set_signal", &S::set_signal, nb::arg("name"), nb::arg("values"))
      .def("save", &S::save)
      .def("begin_record", &S::begin_record, nb::arg("out"), nb::arg("start"))
      .def("end_record", &S::end_record)
      .def_prop_ro("is_recording", &S::is_recording)
      .def_prop_ro("threads", &S::threads)
      .def_prop_ro("status", looks([](const Simulation& s) { return word(s.status()); }))
      .def_prop_ro(
          "advice",
          [](S& self) { return self.with([&](const Simulation& s) { return advice(self.scenario(), s.model()); }); })
      .def_prop_ro("failure", looks([](const Simulation& s) { return s.failure(); }))
      .def_prop_ro("time_s", looks([](const Simulation& s) { return s.time_s(); }))
      .def_prop_ro("end_s", looks([](const Simulation& s) { return s.controls().end_s; }))
      .def(
          "time_left",
          [](S& self, double until_s) {
            return self.with([&](const Simulation& s) {
              RunControls controls = s.controls();
              controls.end_s = std::min(controls.end_s, until_s);
              return TimeLeft(std::move(controls), builtin_curve(self.scenario()), s.time_s());
            });
          },
          nb::arg("until_s"))
      .def_prop_ro("steps", looks([](const Simulation& s) { return s.steps(); }))
      .def_prop_ro("divisions", looks([](const Simulation& s) { return s.divisions(); }))
      .def_prop_ro("computing_s", looks([](const Simulation& s) { return s.computing_s(); }))
      .def_prop_ro("measures", looks(measures))
      .def_prop_ro(
          "crossing_warning",
          [](S& self) { return self.with([&](const Simulation& s) { return crossing_warning(self.scenario(), s); }); })
      .def_prop_ro("warnings",
                   [](S& self) {
                     std::vector<std::string> texts;
                     for (const RunWarning& warning :
                          self.with([&](const Simulation& s) { return run_warnings(self.scenario(), s); }))
                       texts.push_back(warning.text);
                     return texts;
                   })
      .def_prop_ro("positions", of_state(&State::positions))
      .def_prop_ro("velocities", of_state(&State::velocities))
      .def_prop_ro("pressures", looks(pressures_Pa))
      .def_prop_ro("cell_data", looks(cell_data))
      .def_prop_ro("signals", looks(concentrations))
      .def_prop_ro("regions", looks(regions))
      .def_prop_ro("neighbours", looks(neighbours))
      .def_prop_ro("walls", looks(walls))
      .def_prop_ro("energies", looks(energies))
      .def_prop_ro("rest_positions",
                   of_tissue([](const Tissue& t) { return array_of(std::span<const Vec3>(t.rest_positions)); }))
      .def_prop_ro("hexahedra", of_tissue([](const Tissue& t) { return array_of_ids(t.elements, 8); }))
      .def_prop_ro("hexahedron_cell", of_tissue([](const Tissue& t) {
                     std::vector<int> cells;
                     for (const CellId cell : t.element_cell) cells.push_back(cell.number());
                     return array_of(std::move(cells));
                   }))
      .def(
          "laws", [](S& self, bool active) { return self.with([&](const Simulation& s) { return laws(s, active); }); },
          nb::arg("active"))
      .def(
          "forces",
          [](S& self, const std::string& law) {
            return self.with([&](const Simulation& s) { return forces(s, law); });
          },
          nb::arg("law"))
      .def(
          "activity",
          [](S& self, const std::string& law) {
            return self.with([&](const Simulation& s) { return activity(s, law); });
          },
          nb::arg("law"))
      .def(
          "wall_factors",
          [](S& self, const std::string& law) {
            return self.with([&](const Simulation& s) { return array_of(wall_factors(s.model(), s.state(), law)); });
          },
          nb::arg("law"))
      .def(
          "strength",
          [](S& self, const std::string& law) {
            return self.with([&](const Simulation& s) { return strength(s, law); });
          },
          nb::arg("law"));
}

}  // namespace plica::python
