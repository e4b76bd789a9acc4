#include "study/unfinished_run.hpp"

#include <optional>
#include <string>
#include <utility>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "record/archive.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;

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
    if (!kept || kept->record.rows.empty() || kept->program != checkpoint_.program ||
        kept->scenario != checkpoint_.scenario || kept->at_rest != checkpoint_.at_rest)
      return at_rest;
    simulation_.go_on_from(std::move(kept->run), kept->record.rows.back());
    earlier_s_ = kept->record.wall_s;
    next_s_ += earlier_s_;
    return std::move(kept->record.rows);
  } catch (const FileError&) {  // damaged: only time is lost
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

void UnfinishedRun::step_accepted(const std::vector<Observation>& rows, double wall_s) {
  if (!can_archive() || wall_s < next_s_ || !simulation_.is_resumable()) return;
  next_s_ = wall_s + every_s_;
  std::error_code error;
  fs::create_directories(directory_, error);
  if (!can_lock()) return;
  if (!files_) files_ = std::make_unique<CheckpointFiles>(directory_);
  checkpoint_.run = simulation_.memory();
  checkpoint_.record.rows = rows;
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
