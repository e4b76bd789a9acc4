// Checkpoints: everything that a run needs to continue bitwise identically (docs/how-to/reliability.md), besides the
// rows of its tables. The last two are kept in checkpoint.h5 and checkpoint.previous.h5, written atomically.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files.hpp"
#include "simulation/run_memory.hpp"

namespace plica {

/// Version of the content; checkpoints of another version are refused.
inline constexpr int checkpoint_format = 14;

/// Files written before the checkpoint.
struct RecordMemory {
  std::map<std::string, std::uint64_t> table_bytes;  // by file name; a resumption truncates tables to these sizes
  std::vector<double> frame_times_s;                 // of the snapshots, in order
  double wall_s = 0, solver_s = 0;                   // of the run so far
};

struct Checkpoint {
  std::string program;   // version of plica that wrote it
  std::string scenario;  // with all defaults
  std::string at_rest;   // fingerprint of the embryo before the first step
  RunMemory run;
  RecordMemory record;
};

/// Fingerprint of an embryo: nodes, elements and cells in the reference state.
std::string fingerprint(const Tissue& tissue);

/// Convert a checkpoint to the bytes of its file, and back. Throws FileError, without a path, for bytes of another
/// kind, damaged bytes, or another version.
std::string checkpoint_bytes(const Checkpoint& checkpoint);
Checkpoint read_checkpoint_bytes(std::string_view bytes);

/// Call `read` in a fork of this process. Throws its FileError or bad_alloc, or FileError if it crashes or takes far
/// longer than reading `bytes` can: HDF5 trusts its input and loops on some damaged bytes with a forged checksum.
void read_on_trial(const std::function<void()>& read, std::size_t bytes);

/// First difference of two resolved scenarios outside [time], [stop] and [output], which a resumption may change; empty
/// if none.
std::optional<std::string> other_scenario(const std::string& before, const std::string& now);

/// Whether two resolved scenarios differ in [stop].
bool other_stop(const std::string& before, const std::string& now);

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
