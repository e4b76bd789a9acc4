// checkpoint.h5 and checkpoint.previous.h5: the last two checkpoints of a run, written after every step, whole or not
// at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/files.hpp"
#include "record/checkpoint.hpp"

namespace plica {

/// Writes the checkpoints of one directory. The one before stays as the previous one when it is on the disk itself
/// (Sync::now): of the two, one outlives a power cut.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::filesystem::path& directory);

  /// Whether the next one should go to the disk itself, and the files that go with it before it: every few seconds.
  [[nodiscard]] bool sync_is_due();

  /// FileError when it cannot be written; the ones before are as they were.
  void write(const Checkpoint& checkpoint, Sync sync);

 private:
  std::filesystem::path newest_, previous_;
  CheckpointBytes bytes_of_;
  double last_sync_s_ = 0;
  bool newest_is_on_disk_ = false;
};

/// The newest checkpoint of a directory that can be read; nothing when there is none. `complaint` says why it is not
/// the last one. FileError when there are some, and none can be read.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& directory, std::string& complaint);

/// Removes the checkpoints of a directory.
void remove_checkpoints(const std::filesystem::path& directory);

/// Whether that is what a checkpoint is called.
bool is_checkpoint(const std::filesystem::path& file_name);

}  // namespace plica
