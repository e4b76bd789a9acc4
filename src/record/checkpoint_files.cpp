#include "record/checkpoint_files.hpp"

#include <fmt/format.h>

#include <chrono>

#include "core/errors.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr const char* newest_name = "checkpoint.h5";
constexpr const char* previous_name = "checkpoint.previous.h5";

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

}  // namespace

CheckpointFiles::CheckpointFiles(const fs::path& directory)
    : newest_(directory / newest_name), previous_(directory / previous_name) {}

bool CheckpointFiles::sync_is_due() {
  constexpr double between_syncs_s = 3;
  if (last_sync_s_ != 0 && now_s() - last_sync_s_ < between_syncs_s) return false;
  last_sync_s_ = now_s();
  return true;
}

void CheckpointFiles::write(const Checkpoint& checkpoint, Sync sync) {
  const fs::path temporary = write_beside(newest_, bytes_of_(checkpoint), sync);
  std::error_code ignored;
  if (newest_is_on_disk_ || !fs::exists(previous_, ignored))
    fs::rename(newest_, previous_, ignored);  // fails without one
  rename_file(temporary, newest_, sync);
  newest_is_on_disk_ = sync == Sync::now;
}

std::optional<Checkpoint> read_checkpoint(const fs::path& directory, std::string& complaint) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{16} << 30;
  std::string complaints;
  for (const char* name : {newest_name, previous_name}) {
    const fs::path file = directory / name;
    std::error_code error;
    if (!fs::exists(file, error)) continue;
    try {
      Checkpoint checkpoint = read_checkpoint_bytes(read_file(file, most_bytes));
      complaint = complaints;
      return checkpoint;
    } catch (const FileError& why) {
      const std::string text = why.what();
      complaints += (complaints.empty() ? "" : "; ") +
                    (text.starts_with(file.string()) ? text : fmt::format("{}: {}", file.string(), text));
    }
  }
  if (!complaints.empty()) throw FileError(complaints + "; restart with --overwrite");
  return std::nullopt;
}

void remove_checkpoints(const fs::path& directory) {
  std::error_code ignored;
  for (const char* name : {newest_name, previous_name}) fs::remove(directory / name, ignored);
}

bool is_checkpoint(const fs::path& file_name) { return file_name == newest_name || file_name == previous_name; }

}  // namespace plica
