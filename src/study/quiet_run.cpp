#include "study/quiet_run.hpp"

#include <chrono>
#include <memory>
#include <optional>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/version.hpp"
#include "measure/measure_set.hpp"
#include "record/archive.hpp"
#include "record/checkpoint.hpp"
#include "record/csv.hpp"
#include "record/summary.hpp"
#include "scenario/print.hpp"
#include "scenario/suggest.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr const char* series_csv = "series.csv";

// Saved state of a long run without results on disk, so that a killed process does not start from the beginning.
class UnfinishedRun {
 public:
  // `simulation`: in its reference state. `directory`: used by this run only, exists only while it contains something.
  // The state is written at the first resumable step after every `every_s` of wall time.
  UnfinishedRun(fs::path directory, double every_s, const Scenario& scenario, Simulation& simulation)
      : directory_(std::move(directory)),
        every_s_(every_s),
        next_s_(every_s),
        simulation_(simulation),
        checkpoint_{version(), resolved_toml(scenario), fingerprint(simulation.model().tissue), {}, {}} {}

  // Resume from the saved state, if one fits, and return the measures of the steps so far; else those of the reference
  // state only.
  std::vector<Observation> begin() {
    std::vector<Observation> at_rest = {simulation_.measures()};
    if (!can_archive() || !is_there(directory_) || !can_lock()) return at_rest;
    try {
      std::string complaint;
      std::optional<Checkpoint> kept = read_checkpoint(directory_, complaint);
      if (!kept || kept->program != checkpoint_.program || kept->scenario != checkpoint_.scenario ||
          kept->at_rest != checkpoint_.at_rest)
        return at_rest;
      open_table(kept->record.table_bytes[series_csv]);
      std::vector<Observation> rows = read_series_rows(directory_ / series_csv, simulation_.observer());
      saved_rows_ = rows.size();
      simulation_.go_on_from(std::move(kept->run));
      earlier_s_ = kept->record.wall_s;
      next_s_ += earlier_s_;
      return rows;
    } catch (const FileError&) {  // damaged: only time is lost
      table_.reset(), saved_rows_ = 0;
      return at_rest;
    }
  }

  [[nodiscard]] double earlier_s() const { return earlier_s_; }  // wall time of earlier processes

  // Save when due; called after each accepted step.
  void step_accepted(const std::vector<Observation>& rows, double wall_s) {
    if (!can_archive() || wall_s < next_s_ || !simulation_.is_resumable()) return;
    next_s_ = wall_s + every_s_;
    make_directory(directory_);
    if (!can_lock()) return;
    if (!files_) files_ = std::make_unique<CheckpointFiles>(directory_);
    checkpoint_.run = simulation_.memory();
    if (!table_) open_table(0);
    for (; saved_rows_ < rows.size(); ++saved_rows_)
      table_->append(series_row(rows[saved_rows_], simulation_.observer().columns()));
    table_->sync();
    checkpoint_.record.table_bytes[series_csv] = table_->size_bytes();
    checkpoint_.record.wall_s = wall_s;
    checkpoint_.record.solver_s = simulation_.computing_s();
    files_->write(checkpoint_, Sync::now);
  }

  // Remove the saved state of a finished run.
  void end() {
    if (!lock_) return;
    std::error_code ignored;
    fs::remove_all(directory_, ignored);
    fs::remove(directory_.parent_path(), ignored);  // if that was the last
  }

 private:
  // Lock the directory, unless another process keeps the same run.
  [[nodiscard]] bool can_lock() {
    try {
      if (!lock_) lock_ = std::make_unique<DirectoryLock>(directory_);
      return true;
    } catch (const FileError&) {
      return false;
    }
  }

  void open_table(std::uint64_t keep_bytes) {
    const fs::path file = directory_ / series_csv;
    table_ = std::make_unique<RowFile>(file, begin_table(file, series_header(simulation_.observer()), keep_bytes));
  }

  fs::path directory_;
  double every_s_, next_s_;
  Simulation& simulation_;
  Checkpoint checkpoint_;
  std::unique_ptr<DirectoryLock> lock_;
  std::unique_ptr<CheckpointFiles> files_;
  std::unique_ptr<RowFile> table_;
  std::size_t saved_rows_ = 0;
  double earlier_s_ = 0;
};

RunSummary ended(const Scenario& scenario, const Simulation& simulation, std::vector<Observation> rows,
                 const WallTimes& wall) {
  return {make_summary(scenario, simulation, rows, wall), std::move(rows), simulation.state(),
          series_header(simulation.observer()), simulation.observer().columns()};
}

}  // namespace

RunSummary quiet_run(const Scenario& scenario, const QuietRunHooks& hooks) {
  const auto start = std::chrono::steady_clock::now();
  const auto stop = [&] { return hooks.stop_requested && hooks.stop_requested(); };
  Simulation simulation(scenario);
  simulation.stop_when(stop);
  if (hooks.leave_out) simulation.leave_out(hooks.leave_out);
  std::optional<UnfinishedRun> kept;
  if (!hooks.keep_in.empty()) kept.emplace(hooks.keep_in, hooks.keep_every_s, scenario, simulation);
  std::vector<Observation> rows = kept ? kept->begin() : std::vector{simulation.measures()};
  const auto wall_s = [&, earlier_s = kept ? kept->earlier_s() : 0] {
    return earlier_s + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  while (!stop() && simulation.step()) {
    rows.push_back(simulation.measures());
    if (hooks.on_row) hooks.on_row(rows.back());
    if (kept) kept->step_accepted(rows, wall_s());
  }
  if (kept && simulation.status() != RunStatus::under_way) kept->end();
  return ended(scenario, simulation, std::move(rows), {wall_s(), simulation.computing_s()});
}

RunSummary run_at_rest(const Scenario& scenario) {
  const Simulation simulation(scenario);
  return ended(scenario, simulation, {simulation.measures()}, {});
}

bool is_a_cost(const std::string& name) { return name == "peak_memory_MB" || name.find("wall_s") != std::string::npos; }

std::string result_remedy(const std::string& name, const std::vector<std::string>& known) {
  const std::string of_set = set_remedy(name);
  return of_set.empty() ? did_you_mean(name, known) : of_set;
}

std::vector<std::string> result_names(const nlohmann::ordered_json& summary) {
  std::vector<std::string> names;
  for (const auto& [name, value] : summary.items())
    if ((value.is_number() || value.is_null()) && name != "stopped_by" && !name.starts_with("fail") && !is_a_cost(name))
      names.push_back(name);
  return names;
}

}  // namespace plica
