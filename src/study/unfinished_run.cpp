#include "study/unfinished_run.hpp"

#include <optional>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "record/archive.hpp"
#include "record/csv.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;

constexpr const char* series_csv = "series.csv";

UnfinishedRun::UnfinishedRun(fs::path directory, double every_s, const Scenario& scenario, Simulation& simulation)
    : directory_(std::move(directory)),
      every_s_(every_s),
      next_s_(every_s),
      simulation_(simulation),
      checkpoint_{version(), resolved_toml(scenario), fingerprint(simulation.model().tissue), {}, {}} {}

std::vector<Observation> UnfinishedRun::begin() {
  std::vector<Observation> at_rest = {simulation_.measures()};
  std::error_code error;
  if (!can_archive() || !fs::exists(directory_, error) || !can_lock()) return at_rest;
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

// Lock the directory, unless another process keeps the same run.
bool UnfinishedRun::can_lock() {
  try {
    if (!lock_) lock_ = std::make_unique<DirectoryLock>(directory_);
    return true;
  } catch (const FileError&) {
    return false;
  }
}

void UnfinishedRun::open_table(std::uint64_t keep_bytes) {
  const fs::path file = directory_ / series_csv;
  table_ = std::make_unique<RowFile>(file, begin_table(file, series_header(simulation_.observer()), keep_bytes));
}

void UnfinishedRun::step_accepted(const std::vector<Observation>& rows, double wall_s) {
  if (!can_archive() || wall_s < next_s_ || !simulation_.is_resumable()) return;
  next_s_ = wall_s + every_s_;
  std::error_code error;
  fs::create_directories(directory_, error);
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

void UnfinishedRun::end() {
  if (!lock_) return;
  std::error_code ignored;
  fs::remove_all(directory_, ignored);
  fs::remove(directory_.parent_path(), ignored);  // if that was the last
}

}  // namespace plica
