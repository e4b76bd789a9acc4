// Keys at the top of the file, [time], [measure], [furrow] and [output]: what a run is called, computes and writes.
#include "core/clock.hpp"
#include "measure/measure_set.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_run {

std::vector<std::string_view> set_names() {
  std::vector<std::string_view> names = {"automatic"};
  for (const MeasureSet& set : measure_sets())
    if (!set.name.empty()) names.push_back(set.name);
  return names;
}

using T = TimeInput;

void check_time(const TimeInput& time, Input& input) {
  if (input.sound("time.end_s") && has_come(time.end_s, 0))
    input.report("time.end_s", fmt::format("the run would end before its first step, at {} s", time.end_s),
                 "set end_s to a later time");
  if (!input.sound("time.first_step_s") || !input.sound("time.max_step_s")) return;
  if (time.first_step_s > time.max_step_s)
    input.report("time.first_step_s", fmt::format("{} is above max_step_s, {}", time.first_step_s, time.max_step_s),
                 "set first_step_s to at most max_step_s");
}

void check_integrator(const Scenario& scenario, Input& input) {
  if (!input.sound("time.integrator") || scenario.time.integrator != "bdf2") return;
  if (const std::string why = what_bars_second_order(scenario); !why.empty())
    input.report("time.integrator", "\"bdf2\" does not support " + why, "set integrator to \"backward-euler\"");
}

}  // namespace of_run

ScenarioTable top_table() {
  using S = Scenario;
  ScenarioTable info{"", "Keys at the top of the file.", "General"};
  const KeyRows<S> row{"", [](S& scenario, const std::string&) -> S& { return scenario; }};
  info.rows = {
      row("format", &S::format, between(1, 1), "Version of the file format."),
      row("title", &S::title, anything, "One line for reports."),
      {"", "base", [](S&, const std::string&) -> Slot { return std::monostate(); }, anything,
       "Scenario to inherit from, key by key: built-in name, or path relative to this file. A new `embryo.shape` drops "
       "inherited `[embryo]` keys it does not use; a new region selector drops an inherited `face` or `array` that the "
       "shape lacks."},
  };
  return info;
}

ScenarioTable time_table() {
  using namespace of_run;
  ScenarioTable info{"time", "Time steps and end of the run.", "Run"};
  const auto row = key_rows("time", &Scenario::time);
  info.rows = {
      row("step_s", &T::step_s, {.low = instant_s, .word_for_none = "adaptive"},
          "Time step (s), or adaptive by local error."),
      row("first_step_s", &T::first_step_s, positive, "First adaptive step (s)."),
      row("max_step_s", &T::max_step_s, positive, "Longest adaptive step (s)."),
      row("tolerance_um", &T::tolerance_um, positive, "Local error tolerance of an adaptive step, on positions (µm)."),
      row("end_s", &T::end_s, positive, "End of the run (s)."),
      row("end_min", &T::end_s, positive, "`end_s` in minutes.", {.instead_of = "end_s", .scale = 60}),
      row("scheme", &T::scheme, one_of(words::schemes),
          "Step solver: Newton's method, or one linear system by conjugate gradients (the paper)."),
      row("integrator", &T::integrator, one_of(words::integrators),
          "First or second order in time. `bdf2` requires scheme `newton`, no inertia and no projection. `automatic`: "
          "`bdf2` where it can be, else `backward-euler`."),
      row("linear_solver", &T::linear_solver, one_of(words::linear_solvers),
          "Linear solver in Newton's method: factorization of the whole system (`direct`), or a Krylov method with a "
          "factorization of its positive definite part (`cholesky`) or with multigrid; `automatic`: by size. Results "
          "differ by less than the tolerances."),
      row("cg_tolerance", &T::cg_tolerance, {.low = 1e-14, .high = 0.1},
          "Relative residual of conjugate gradients (`linearly-implicit`)."),
      row("cg_max_iterations", &T::cg_max_iterations, between(1, 1000000),
          "Iterations after which conjugate gradients fail (`linearly-implicit`)."),
  };
  info.rules = [](Scenario& scenario, Input& input) {
    check_time(scenario.time, input);
    if (scenario.time.scheme != "linearly-implicit") {
      const std::string chooser = "time.scheme", choice = "linearly-implicit";
      drop_unless_chosen(scenario.time, &T::cg_tolerance, "time.cg_tolerance", chooser, choice, input);
      drop_unless_chosen(scenario.time, &T::cg_max_iterations, "time.cg_max_iterations", chooser, choice, input);
    }
    check_integrator(scenario, input);
  };
  return info;
}

ScenarioTable measure_table() {
  using namespace of_run;
  ScenarioTable info{"measure", "What is measured.", "Output"};
  const auto row = key_rows("measure", &Scenario::measure);
  info.rows = {
      row("sets", &MeasureInput::sets, one_of(set_names()),
          "Sets of [output variables](measures.md#sets) to measure; `automatic`: those that fit the tissue.",
          {.may_be_empty = true}),
  };
  return info;
}

ScenarioTable furrow_table() {
  ScenarioTable info{"furrow", "Where the furrow is measured.", "Output"};
  const auto row = key_rows("furrow", &Scenario::furrow);
  info.rows = {
      row("region", &FurrowInput::region, anything,
          "Contractile cells that form the furrow; default the largest contracting region."),
      row("vce_cell", &FurrowInput::vce_cell, between(1, max_count),
          "Position of the near-end midline cell (VCE), counted from the ends; default 2, if present."),
  };
  info.regions = [](const Scenario& scenario, const TakeRegion& take) {
    take("furrow.region", scenario.furrow.region);
  };
  return info;
}

ScenarioTable output_table() {
  using O = OutputInput;
  ScenarioTable info{"output", "Files of a run.", "Output"};
  const auto row = key_rows("output", &Scenario::output);
  info.rows = {
      row("frame_every_s", &O::frame_every_s, not_negative,
          "Time between frames (snapshots; s); 0: first and last only."),
      row("frame_every_min", &O::frame_every_s, not_negative, "`frame_every_s` in minutes.",
          {.instead_of = "frame_every_s", .scale = 60}),
      row("cells_csv", &O::cells_csv, anything, "Write cells.csv; default up to 2000 cells."),
  };
  return info;
}

}  // namespace plica
