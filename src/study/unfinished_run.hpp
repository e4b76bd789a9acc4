// A run without results on disk that takes long, kept there all the same: whoever is killed does not begin anew.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "core/directory_lock.hpp"
#include "measure/observation.hpp"
#include "record/checkpoint_files.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"

namespace plica {

class UnfinishedRun {
 public:
  /// Of a simulation at rest. `directory` is its own, and there only while there is something in it; `every_s` of wall
  /// time what the run has come to is written.
  UnfinishedRun(std::filesystem::path directory, double every_s, const Scenario& scenario, Simulation& simulation);

  /// Goes on from what is kept, and says what the steps so far have measured; at rest only, where nothing is kept that
  /// fits.
  [[nodiscard]] std::vector<Observation> begin();
  /// Wall time of the processes before this one.
  [[nodiscard]] double earlier_s() const { return earlier_s_; }

  /// After each step that is accepted. FileError when it cannot be written.
  void step_accepted(const std::vector<Observation>& rows, double wall_s);

  /// Nothing is kept of a run that has ended.
  void end();

 private:
  [[nodiscard]] bool can_lock();

  std::filesystem::path directory_;
  double every_s_, next_s_;
  Simulation& simulation_;
  Checkpoint checkpoint_;
  std::unique_ptr<DirectoryLock> lock_;
  std::unique_ptr<CheckpointFiles> files_;
  double earlier_s_ = 0;
};

}  // namespace plica
