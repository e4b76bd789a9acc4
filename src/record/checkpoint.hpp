// What is in checkpoint.h5: everything that a run needs to go on to the same bits. docs/how-to/reliability.md says what
// is promised of it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "measure/observation.hpp"
#include "record/archive.hpp"
#include "simulation/run_memory.hpp"

namespace plica {

/// Grows when what is in a checkpoint changes; those of another format are refused.
inline constexpr int checkpoint_format = 6;

/// What had been written when the checkpoint was: files are cut back to it.
struct RecordMemory {
  std::vector<Observation> rows;  // of series.csv
  std::uint64_t series_bytes = 0, lineage_bytes = 0, midline_bytes = 0, section_bytes = 0,
                cells_bytes = 0;      // 0: no such file
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

/// Calls `read` in a copy of this process. Its FileError and bad_alloc come out here; a FileError, too, when it crashes
/// or takes far longer than reading `bytes` can: HDF5 trusts what is in a file, and a few damaged bytes, under a
/// checksum that was made for them, send it round in circles.
void read_on_trial(const std::function<void()>& read, std::size_t bytes);

/// The same for the checkpoints of a run, one after the other: of each only what is new is made anew, which takes a
/// fifth of the time. The first one's bytes are those of checkpoint_bytes.
class CheckpointBytes {
 public:
  std::string operator()(const Checkpoint& checkpoint);

 private:
  std::unique_ptr<ArchiveWriter> archive_;  // of the last one, as long as it is small
};

/// Whether two resolved scenarios differ in more than [time], [stop] and [output], which may change at a resume: the
/// first line that does, or nothing.
std::optional<std::string> other_scenario(const std::string& before, const std::string& now);

/// Whether they differ in [stop].
bool other_stop(const std::string& before, const std::string& now);

}  // namespace plica
