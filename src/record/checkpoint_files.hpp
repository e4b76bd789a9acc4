// Files checkpoint.h5 and checkpoint.previous.h5: the last two checkpoints of a run, written atomically.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/files.hpp"
#include "record/checkpoint.hpp"

namespace plica {

/// Writer of the checkpoints of one directory. Keeps a checkpoint synced to disk (Sync::now) as the previous one, so
/// that one of the two survives a power cut.
class CheckpointFiles {
 public:
  explicit CheckpointFiles(const std::filesystem::path& directory);

  /// Whether the next checkpoint, after its files, should be synced to disk: every few seconds.
  [[nodiscard]] bool sync_is_due();

  /// Write a checkpoint. Throws FileError and leaves earlier ones unchanged.
  void write(const Checkpoint& checkpoint, Sync sync);

 private:
  std::filesystem::path newest_, previous_;
  CheckpointBytes bytes_of_;
  double last_sync_s_ = 0;
  bool newest_is_on_disk_ = false;
};

/// Read the newest readable checkpoint of a directory; empty if there is none. `complaint`: reason if it is not the
/// last one. Throws FileError if checkpoints exist but none is readable.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& directory, std::string& complaint);

/// Remove the checkpoints of a directory.
void remove_checkpoints(const std::filesystem::path& directory);

/// Whether the name is that of a checkpoint.
bool is_checkpoint(const std::filesystem::path& file_name);

}  // namespace plica
