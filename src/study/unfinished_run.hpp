// Saved state of a long run without results on disk, so that a killed process does not start from the beginning.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/files.hpp"
#include "measure/observation.hpp"
#include "record/checkpoint.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"

namespace plica {

class UnfinishedRun {
 public:
  /// `simulation`: in its reference state. `directory`: used by this run only, exists only while it contains something.
  /// The state is written at the first resumable step after every `every_s` of wall time.
  UnfinishedRun(std::filesystem::path directory, double every_s, const Scenario& scenario, Simulation& simulation);

  /// Resume from the saved state, if one fits, and return the measures of the steps so far; else those of the reference
  /// state only.
  [[nodiscard]] std::vector<Observation> begin();
  /// Wall time of earlier processes, s.
  [[nodiscard]] double earlier_s() const { return earlier_s_; }

  /// Save when due; call after each accepted step. Throws FileError.
  void step_accepted(const std::vector<Observation>& rows, double wall_s);

  /// Remove the saved state of a finished run.
  void end();

 private:
  [[nodiscard]] bool can_lock();
  void open_table(std::uint64_t keep_bytes);

  std::filesystem::path directory_;
  double every_s_, next_s_;
  Simulation& simulation_;
  Checkpoint checkpoint_;
  std::unique_ptr<DirectoryLock> lock_;
  std::unique_ptr<CheckpointFiles> files_;
  std::unique_ptr<RowFile> table_;
  std::size_t saved_rows_ = 0;
  double earlier_s_ = 0;
};

}  // namespace plica
