// Content of checkpoint.h5: everything that a run needs to continue bitwise identically (docs/how-to/reliability.md).
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

/// Version of the content; checkpoints of another version are refused.
inline constexpr int checkpoint_format = 8;

/// Files written before the checkpoint; a resumption truncates them to these sizes.
struct RecordMemory {
  std::vector<Observation> rows;  // of series.csv
  std::uint64_t series_bytes = 0, lineage_bytes = 0, midline_bytes = 0, section_bytes = 0,
                cells_bytes = 0;      // 0: no such file
  std::vector<double> frame_times_s;  // of the snapshots, in order
  double wall_s = 0, solver_s = 0;    // of the run so far
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

/// Converter for successive checkpoints of a run: rebuilds only what is new, in a fifth of the time. The first result
/// equals checkpoint_bytes.
class CheckpointBytes {
 public:
  std::string operator()(const Checkpoint& checkpoint);

 private:
  std::unique_ptr<ArchiveWriter> archive_;  // of the last checkpoint, if small
};

/// First line in which two resolved scenarios differ outside [time], [stop] and [output], which a resumption may
/// change; empty if none.
std::optional<std::string> other_scenario(const std::string& before, const std::string& now);

/// Whether two resolved scenarios differ in [stop].
bool other_stop(const std::string& before, const std::string& now);

}  // namespace plica
