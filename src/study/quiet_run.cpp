#include "study/quiet_run.hpp"

#include <chrono>

#include "record/summary.hpp"
#include "scenario/setup.hpp"
#include "scenario/watch.hpp"

namespace plica {
namespace {

// What a run needs, made from its scenario.
struct Setting {
  explicit Setting(const Scenario& scenario)
      : model(make_model(scenario)),
        observer(*model, make_furrow_sites(scenario, model->tissue), make_watch(scenario, model->tissue)),
        rest(rest_state(*model)),
        rows{observer.observe_rest(rest)} {}

  std::unique_ptr<Model> model;
  Observer observer;
  State rest;
  std::vector<Observation> rows;
};

}  // namespace

RunSummary quiet_run(const Scenario& scenario, const QuietRunHooks& hooks) {
  const auto start = std::chrono::steady_clock::now();
  const auto wall_s = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  Setting setting(scenario);
  const auto stop = [&] { return hooks.stop_requested && hooks.stop_requested(); };
  const RunResult result = run(
      *setting.model, setting.rest, make_controls(scenario, *setting.model),
      [&](const AcceptedStep& step) {
        const Observation& row = setting.rows.emplace_back(setting.observer.observe(step, wall_s()));
        if (hooks.on_row) hooks.on_row(row);
        return StepAnswer(!stop(), row.is_over);
      },
      stop, [&](const Division& division, const State&) { setting.observer.follow_division(division); });
  const WallTimes wall{wall_s(), wall_s()};
  return {make_summary(scenario, *setting.model, result, setting.rows, setting.observer.monitors(), wall),
          std::move(setting.rows), result.state};
}

RunSummary run_at_rest(const Scenario& scenario) {
  Setting setting(scenario);
  RunResult result;
  result.state = setting.rest;
  return {make_summary(scenario, *setting.model, result, setting.rows, setting.observer.monitors(), {}),
          std::move(setting.rows), result.state};
}

}  // namespace plica
