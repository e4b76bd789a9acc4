#include "study/run_study.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include "core/errors.hpp"
#include "core/threads.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

// Check the free disk space, from what the first run has written, rather than fail after hours.
void require_room(const fs::path& directory, const std::string& run, std::size_t left) {
  std::error_code error;
  const auto free = static_cast<double>(fs::space(directory, error).available);
  const double needed = static_cast<double>(bytes_in(directory / "points" / run)) * static_cast<double>(left);
  if (!error && needed > free)
    throw FileError(
        fmt::format("{}: the other {} runs need {:.1f} GB, but only {:.1f} GB are free; keep less "
                    "(keep.each), give another --out, or free space and continue with --resume",
                    directory.string(), left, needed / 1e9, free / 1e9));
}

}  // namespace

void run_study(const Study& study, StudyDirectory& directory, Workers workers, const std::vector<std::size_t>& runs,
               const StudyHooks& hooks) {
  std::vector<std::size_t> open = directory.open_runs();
  if (!runs.empty()) std::erase_if(open, [&](std::size_t run) { return !std::ranges::binary_search(runs, run); });

  const ThreadCount one(1);
  const auto row_of = [&](std::size_t run) -> std::string {
    const ThreadCount count(workers.threads);
    const std::optional<RunRow> row = study.run(run, directory.path(), worker_is_to_stop);
    return row ? study.line_of(run, *row) : "";
  };
  bool has_room = study.input().each == KeptOfRun::row;  // or checked already
  std::size_t left = open.size();
  const auto take = [&](std::size_t run, const std::string& answer, const std::string& reason) {
    const std::string row = reason.empty() ? answer : study.line_without_result(run, reason);
    if (row.empty()) return;  // another process is running it
    directory.add(run, row);
    --left;
    if (!std::exchange(has_room, true)) require_room(directory.path(), study.name_of(run), left);
    if (hooks.on_row) hooks.on_row(run, row);
  };
  work_in_processes(workers.processes, open, row_of, {take, hooks.stop_requested});
}

StudyForecast forecast(const Study& study, const std::function<bool()>& stop) {
  StudyForecast result;
  result.runs = study.runs();
  std::set<int> points;
  std::optional<std::size_t> first;
  for (std::size_t r = 0; r < study.runs(); ++r) {
    const StudyPoint& run = study.design().runs[r];
    if (!points.insert(run.point).second) continue;
    try {
      (void)study.scenario_of(r);
      if (!first) first = r;
    } catch (const ScenarioError& error) {
      result.refused.push_back(fmt::format("point {}: {}", run.point, error.what()));
    }
  }
  result.points = points.size();
  result.first_run = first.value();  // exists in any valid study
  std::string directory = (fs::temp_directory_path() / "plica-study-XXXXXX").string();
  if (::mkdtemp(directory.data()) == nullptr)
    throw FileError(directory + ": cannot be created: " + std::generic_category().message(errno));
  const std::shared_ptr<void> removal(nullptr, [&](void*) {
    std::error_code ignored;
    fs::remove_all(directory, ignored);
  });
  if (const std::optional<RunRow> row = study.run(result.first_run, directory, stop)) result.first = *row;
  result.bytes_a_run = static_cast<double>(bytes_in(directory)) +
                       2 * static_cast<double>(study.line_of(result.first_run, result.first).size());
  return result;
}

}  // namespace plica
