#include "study/run_study.hpp"

#include <numeric>

#include "core/threads.hpp"
#include "study/worker_pool.hpp"

namespace plica {

void run_study(const Study& study, StudyDirectory& directory, int jobs, const std::vector<std::size_t>& runs,
               const StudyHooks& hooks) {
  std::vector<std::size_t> open = runs;
  if (runs.empty()) {
    open.resize(study.runs());
    std::iota(open.begin(), open.end(), 0);
  }
  const StudyRows done = directory.rows();
  std::erase_if(open, [&](std::size_t run) { return done.contains(run); });

  const ThreadCount one(1);
  const auto row_of = [&](std::size_t run) -> std::string {
    const std::optional<RunRow> row = study.run(run, directory.path(), worker_is_to_stop);
    return row ? study.line_of(run, *row) : "";
  };
  const auto take = [&](std::size_t run, const std::string& answer, const std::string& reason) {
    RunRow crashed = study.not_run();
    crashed.status = "crashed", crashed.reason = reason;
    const std::string row = reason.empty() ? answer : study.line_of(run, crashed);
    if (row.empty()) return;  // another process is at it
    directory.add(run, row);
    if (hooks.on_row) hooks.on_row(run, row);
  };
  work_in_processes(jobs, open, row_of, {take, hooks.stop_requested});
}

}  // namespace plica
