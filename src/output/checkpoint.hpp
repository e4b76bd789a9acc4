// checkpoint.h5: everything that a run needs to go on to the same bits. Written after every step, whole or not at all;
// the one before it is kept, too (checkpoint.previous.h5). docs/checkpoints.md says what is in it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "measure/observation.hpp"
#include "simulation/run.hpp"

namespace plica {

/// What had been written when the checkpoint was: files are cut back to it.
struct RecordMemory {
  std::vector<Observation> rows;                                                          // of series.csv
  std::uint64_t series_bytes = 0, lineage_bytes = 0, midline_bytes = 0, cells_bytes = 0;  // 0: no such file
  std::vector<double> frame_times_s;  // of the frames, in their order
  double wall_s = 0, solver_s = 0;    // of the run so far
};

struct Checkpoint {
  std::string program;   // which plica wrote it
  std::string scenario;  // as resolved
  std::string at_rest;   // fingerprint of the embryo before the first step
  RunMemory run;
  RecordMemory record;
};

/// Tells embryos apart: nodes, elements and cells at rest.
std::string fingerprint(const Tissue& tissue);

/// The checkpoint as the bytes of its file, and back. FileError, without a path, when the bytes are none, or damaged,
/// or of a newer plica.
std::string checkpoint_bytes(const Checkpoint& checkpoint);
Checkpoint read_checkpoint_bytes(std::string_view bytes);

/// Whether it fits the model, which has the past divisions behind it: sizes, and numbers of nodes and cells. What is
/// wrong, or nothing.
std::optional<std::string> why_unfit(const Checkpoint& checkpoint, const Model& model);
/// The same of a division that is to be made again.
std::optional<std::string> why_unfit(const PastDivision& past, const Model& model);

/// Whether two resolved scenarios differ in more than [time], [stop] and [output], which may change at a resume: the
/// first line that does, or nothing.
std::optional<std::string> other_scenario(const std::string& before, const std::string& now);

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
  double last_sync_s_ = 0;
  bool newest_is_on_disk_ = false;
};

/// The newest checkpoint of a directory that can be read; nothing when there is none. `complaint` says why it is not
/// the last one. FileError when there are some, and none can be read.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& directory, std::string& complaint);

/// Removes the checkpoints of a directory.
void remove_checkpoints(const std::filesystem::path& directory);

}  // namespace plica
