#include "record/checkpoint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <libdeflate.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <new>

#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "core/number_list.hpp"
#include "record/archive.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr const char* newest_name = "checkpoint.h5";
constexpr const char* previous_name = "checkpoint.previous.h5";
constexpr std::size_t trailer_bytes = 64;

std::uint32_t checksum(std::string_view bytes) { return libdeflate_crc32(0, bytes.data(), bytes.size()); }

// Trailer after the HDF5 file; readers of HDF5 ignore it.
std::string trailer(std::string_view image) {
  std::string text =
      fmt::format("\nplica checkpoint {} bytes {} crc32 {:08x}", checkpoint_format, image.size(), checksum(image));
  text.resize(trailer_bytes - 1, ' ');
  return text + "\n";
}

double now_s() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

[[noreturn]] void refuse(const std::string& name) {
  throw FileError(fmt::format("it is damaged: {} is invalid", name));
}

template <class... Values>
void take(const char* name, std::vector<double>& numbers, Values&... values) try {
  take_numbers(std::move(numbers), values...);
} catch (const InvalidNumbers&) {
  refuse(name);
}

// Write a constant checkpoint to an archive, or read another from it.
template <class AnyCheckpoint>
void pass(AnyCheckpoint& checkpoint, Archive& archive) {
  constexpr bool writes = std::is_const_v<AnyCheckpoint>;
  const auto text = [&](const char* name, auto& value) {
    if constexpr (writes)
      archive.texts[name] = value;
    else
      value = archive.texts[name];
  };
  const auto numbers = [&](const char* name, auto&... values) {
    if constexpr (writes)
      archive.numbers[name] = as_numbers(values...);
    else
      take(name, archive.numbers[name], values...);
  };
  auto& [program, scenario, at_rest, run, record] = checkpoint;
  text("program", program), text("scenario", scenario), text("at_rest", at_rest);
  // Values of other columns are refused instead of misread.
  const std::string known = fmt::format("{}", fmt::join(names_of(columns()), " "));
  std::conditional_t<writes, const std::string, std::string> names = known;
  text("columns", names);
  if (names != known) throw FileError("it was written by another version of plica with other columns");
  auto& state = run.state;
  auto& trend = state.trend;
  numbers("state", state.time_s, state.positions, state.velocities, state.multipliers, state.obstacle_forces,
          state.on_obstacle, state.internals, state.signals, state.divided_until_s, state.exchanges, trend.step_s,
          trend.earlier_s, trend.mean_velocities, trend.accelerations, trend.multiplier_rates);
  auto& measures = run.measures;
  numbers("measures", measures.values, measures.monitors, measures.criteria_met, measures.is_over);
  numbers("run", run.steps, run.divisions, run.equilibrium_time_s, run.at_equilibrium, run.wanted_step_s,
          run.careful_steps, run.pace.since_s, run.pace.steps, run.pace.iterations, run.computing_s, run.energies,
          run.whole_internals, run.outside_arrays);
  numbers("changes", run.changes, run.growth_ends_s);
  numbers("record", record.table_bytes, record.frame_times_s, record.wall_s, record.solver_s);
}

Archive archive_of(const Checkpoint& checkpoint) {
  Archive archive;
  pass(checkpoint, archive);
  return archive;
}

Checkpoint checkpoint_in(std::string_view image) {
  Archive archive = archive_of({});  // of the names
  read_archive(image, archive);
  Checkpoint checkpoint;
  pass(checkpoint, archive);
  if (!fits_columns(checkpoint.run.measures)) refuse("measures");
  return checkpoint;
}

/// Limit of processor time: some seconds, plus one per 10 MB, a hundred times the usual duration.
void limit_time(std::size_t bytes) {
  const rlim_t seconds = 3 + bytes / 10'000'000;
  const rlimit limit{seconds, seconds + 1};
  ::setrlimit(RLIMIT_CPU, &limit);
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
}

}  // namespace

void read_on_trial(const std::function<void()>& read, std::size_t bytes) {
  // Answer: a letter for its kind, then the error.
  const std::optional<std::string> answer = output_of_child("the trial reading of a checkpoint", [&]() -> std::string {
    limit_time(bytes);
    try {
      read();
      return "r";
    } catch (const FileError& error) {
      return std::string("f") + error.what();
    } catch (const std::bad_alloc&) {
      return "m";
    }
  });
  if (!answer || answer->empty()) throw FileError("it is damaged: HDF5 crashed while reading it");
  if (answer->front() == 'f') throw FileError(answer->substr(1));
  if (answer->front() == 'm') throw std::bad_alloc();
}

std::string fingerprint(const Tissue& tissue) {
  std::uint32_t sum = 0;
  const auto add = [&](const void* bytes, std::size_t count) { sum = libdeflate_crc32(sum, bytes, count); };
  add(tissue.rest_positions.data(), tissue.rest_positions.size() * sizeof(Vec3));
  add(tissue.elements.data(), tissue.elements.size() * sizeof(tissue.elements.front()));
  add(tissue.element_cell.data(), tissue.element_cell.size() * sizeof(CellId));
  return fmt::format("{} nodes, {} elements, {} cells, crc32 {:08x}", tissue.node_count(), tissue.elements.size(),
                     tissue.cells.size(), sum);
}

std::string checkpoint_bytes(const Checkpoint& checkpoint) {
  std::string bytes = archive_bytes(archive_of(checkpoint));
  return bytes += trailer(bytes);
}

Checkpoint read_checkpoint_bytes(std::string_view bytes) {
  if (bytes.size() < trailer_bytes) throw FileError("it is not a checkpoint, or truncated");
  const std::string_view image = bytes.substr(0, bytes.size() - trailer_bytes), end = bytes.substr(image.size());
  constexpr std::string_view start = "\nplica checkpoint ";
  if (!end.starts_with(start)) throw FileError("it is not a checkpoint, or truncated");
  if (!end.substr(start.size()).starts_with(fmt::format("{} ", checkpoint_format)))
    throw FileError(
        fmt::format("it was written by another version of plica in a format other than {}", checkpoint_format));
  if (end != trailer(image)) throw FileError("it is damaged: its checksum does not match its content");
  read_on_trial([&] { (void)checkpoint_in(image); }, image.size());
  return checkpoint_in(image);
}

std::optional<std::string> other_scenario(const std::string& before, const std::string& now) {
  for (const KeyDifference& one : scenario_differences(before, now))
    if (!one.key.starts_with("time.") && !one.key.starts_with("output.") && !one.key.starts_with("stop."))
      return one.text();
  return std::nullopt;
}

bool other_stop(const std::string& before, const std::string& now) {
  return std::ranges::any_of(scenario_differences(before, now),
                             [](const KeyDifference& one) { return one.key.starts_with("stop."); });
}

CheckpointFiles::CheckpointFiles(const fs::path& directory)
    : newest_(directory / newest_name), previous_(directory / previous_name) {}

bool CheckpointFiles::sync_is_due() {
  constexpr double between_syncs_s = 3;
  if (last_sync_s_ != 0 && now_s() - last_sync_s_ < between_syncs_s) return false;
  last_sync_s_ = now_s();
  return true;
}

void CheckpointFiles::write(const Checkpoint& checkpoint, Sync sync) {
  const fs::path temporary = write_beside(newest_, checkpoint_bytes(checkpoint), sync);
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
