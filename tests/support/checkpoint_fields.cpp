#include "support/checkpoint_fields.hpp"

#include <concepts>

#include "core/number_list.hpp"

namespace plica::support {
namespace {

void add(std::vector<double>& to, double number) { to.push_back(number); }

void add(std::vector<double>& to, const Vec3& vector) { to.insert(to.end(), vector.begin(), vector.end()); }

void add(std::vector<double>& to, const std::optional<double>& value) {
  to.push_back(value ? 1 : 0);
  to.push_back(value.value_or(0));
}

// A list: how long it is, and what is in it.
template <class List>
requires requires(const List& list) {
  list.size();
  list.begin();
} &&(!std::same_as<List, Vec3>)void add(std::vector<double>& to, const List& list) {
  to.push_back(static_cast<double>(list.size()));
  for (const auto& value : list) add(to, value);
}

struct Fields {
  std::map<std::string, std::vector<double>> numbers;

  template <class Value>
  void take(const std::string& name, const Value& value) {
    add(numbers[name], value);
  }

  void take_state(const State& state) {
    const auto& [time_s, positions, velocities, multipliers, obstacle_forces, on_obstacle, internals, signals,
                 divided_until_s, exchanges, trend] = state;
    take("time_s", time_s), take("positions", positions), take("velocities", velocities);
    take("multipliers", multipliers), take("obstacle_forces", obstacle_forces), take("on_obstacle", on_obstacle);
    take("internals", internals), take("signals", signals), take("divided_until_s", divided_until_s);
    numbers["exchanges"] = as_numbers(exchanges);
    const auto& [step_s, earlier_s, mean_velocities, accelerations, multiplier_rates] = trend;
    take("trend.step_s", step_s), take("trend.earlier_s", earlier_s), take("trend.mean_velocities", mean_velocities);
    take("trend.accelerations", accelerations), take("trend.multiplier_rates", multiplier_rates);
  }

  void take_run(const RunMemory& run) {
    const auto& [state, measures, steps, divisions, equilibrium_time_s, at_equilibrium, wanted_step_s, careful_steps,
                 pace, computing_s, energies, changes, growth_ends_s, whole_internals, outside_arrays] = run;
    take_state(state);
    const auto& [measured, monitors, criteria_met, is_over] = measures;
    take("measures", measured), take("monitors", monitors), take("criteria_met", criteria_met),
        take("is_over", is_over);
    take("steps", steps), take("divisions", divisions), take("equilibrium_time_s", equilibrium_time_s);
    take("at_equilibrium", at_equilibrium);
    take("wanted_step_s", wanted_step_s), take("careful_steps", careful_steps), take("computing_s", computing_s);
    const auto& [since_s, pace_steps, iterations] = pace;
    take("pace.since_s", since_s), take("pace.steps", pace_steps), take("pace.iterations", iterations);
    numbers["energies"];
    for (const auto& [active, stored, dissipated] : energies)
      take("energies", active), take("energies", stored), take("energies", dissipated);
    take("whole_internals", whole_internals);
    numbers["outside_arrays"];
    for (const auto& [name, values] : outside_arrays) take("outside_arrays", name), take("outside_arrays", values);
    take("growth_ends_s", growth_ends_s);
    take_changes(changes ? *changes : ModelMemory());
  }

  void take_changes(const ModelMemory& changes) {
    const auto& [origin, sheet, rest_positions, cells, next_cell_id, held, growths, laws] = changes;
    take("origin", as_numbers(origin)), take("rest_positions", rest_positions), take("next_cell_id", next_cell_id);
    take("held", as_numbers(held)), take("growths", as_numbers(growths)), take("laws", laws);
    take("vertices", as_numbers(sheet.vertices)), take("polygons", as_numbers(sheet.cells));
    for (const char* part : {"rest_shape", "target_volume", "lineage"}) numbers[part];
    for (const Cell& cell : cells) {
      take("rest_shape", cell.rest_shape), take("target_volume", cell.target_volume);
      take("lineage", as_numbers(cell.lineage));
    }
  }

  void take_record(const RecordMemory& record) {
    const auto& [table_bytes, frame_times_s, wall_s, solver_s] = record;
    numbers["table_bytes"];
    for (const auto& [name, bytes] : table_bytes)
      take("table_bytes", name), take("table_bytes", static_cast<double>(bytes));
    take("frame_times_s", frame_times_s), take("wall_s", wall_s), take("solver_s", solver_s);
  }
};

}  // namespace

std::map<std::string, std::vector<double>> fields_of(const Checkpoint& checkpoint) {
  const auto& [program, scenario, at_rest, run, record] = checkpoint;
  Fields fields;
  fields.take("program", program), fields.take("scenario", scenario), fields.take("at_rest", at_rest);
  fields.take_run(run);
  fields.take_record(record);
  return fields.numbers;
}

Checkpoint marked(Checkpoint checkpoint) {
  RunMemory& run = checkpoint.run;
  run.equilibrium_time_s = 1.5;
  run.at_equilibrium = run.measures.is_over = true;
  run.measures.criteria_met = {"folded", "at rest"};
  run.computing_s = 0.25;
  run.energies = {{1, 2, 3}, {4, 5, 6}};
  run.state.obstacle_forces = {0.5, 0, 2};
  run.state.on_obstacle = {1, 0, 1};
  run.state.internals = {{1, 2}, {}, {3}};
  run.state.signals = {{0.5, 2}, {4, 0.25}};
  run.careful_steps = 3;
  run.pace.since_s = 1.5;
  run.outside_arrays = {{"signal", {0.5, 2}}, {"time of birth", {1, 3}}};
  run.whole_internals = {{6}, {7, 8}, {}};
  run.growth_ends_s = {9, 10};
  run.state.exchanges = {12, 3, -4.5, 0.25, {{NodeId(1), NodeId(2), 11}}, 2, 6.5};
  run.state.trend.step_s = 0.75;
  run.state.trend.earlier_s = 0.125;
  run.state.trend.mean_velocities = run.state.trend.accelerations = {Vec3(1, 2, 3), Vec3(-4, 5, 6)};
  run.state.trend.multiplier_rates = {7, 8};
  RecordMemory& record = checkpoint.record;
  record.table_bytes = {{"series.csv", 101}, {"midline.csv", 102}};
  record.wall_s = 17, record.solver_s = 16;
  return checkpoint;
}

}  // namespace plica::support
