#include "paper/reproduce.hpp"

#include <fmt/format.h>

namespace plica {

ReproduceOutcome reproduce(const ReproduceOptions& options,
                           const std::function<void(std::size_t done, std::size_t count)>& tell,
                           const std::function<bool()>& interrupted) {
  const Plan plan = make_plan(options.quick);
  tell(0, plan.runs.size());
  const std::vector<BatchOutcome> ends = run_batch(
      options.directory, plan.runs, options.workers,
      [&](std::size_t done, const BatchRun&) { tell(done, plan.runs.size()); }, interrupted);
  ReproduceOutcome outcome;
  outcome.interrupted = interrupted();
  if (outcome.interrupted) return outcome;
  for (std::size_t i = 0; i < ends.size(); ++i)
    if (ends[i].exit_status != 0)
      outcome.failed_runs.push_back(
          fmt::format("{} (exit status {}): {}", plan.runs[i].id, ends[i].exit_status, ends[i].message));
  const Results results(options.directory, plan);
  const Measured measured = measure(results);
  write_document(options.directory, "reproduction",
                 reproduction_document(results, measured, plan, options.quick, outcome));
  return outcome;
}

}  // namespace plica
