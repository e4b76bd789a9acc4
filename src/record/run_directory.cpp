#include "record/run_directory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <vector>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/checkpoint.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

const std::vector<std::string> own_files = {"summary.json",        "series.csv",        "cells.csv",  "midline.csv",
                                            "lineage.csv",         "cross_section.csv", "frames.pvd", "scenario.toml",
                                            "scenario.input.toml", "report.html"};

// Whether a name is one of frame_file.
bool is_frame(const fs::path& file) {
  const std::string name = file.stem().string();
  return file.extension() == ".vtu" && name.starts_with("frame_") && name.size() >= 11 &&
         name.find_first_not_of("0123456789", 6) == std::string::npos;
}

bool holds_results(const fs::path& directory) {
  for (const std::string& file : own_files)
    if (fs::exists(directory / file)) return true;
  return fs::exists(directory / "frames");
}

}  // namespace

std::string frame_file(std::size_t number) { return fmt::format("frames/frame_{:05}.vtu", number); }

fs::path name_when_whole(const fs::path& name) {
  return name.extension() == ".part" ? name.stem().stem() : name;  // without .PROCESS-NUMBER.part
}

void remove_half_written(const fs::path& directory) {
  std::error_code error;
  const auto is_half_written = [](const fs::path& file) {
    const fs::path own = name_when_whole(file);
    if (own == file) return false;
    return is_frame(own) || is_checkpoint(own) || std::ranges::find(own_files, own.string()) != own_files.end();
  };
  for (const fs::path& folder : {directory, directory / "frames"})
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (is_half_written(entry.path().filename())) fs::remove(entry.path(), error);
}

bool holds_other_files(const fs::path& directory, std::span<const std::string_view> names) {
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (std::ranges::find(names, name_when_whole(entry.path().filename()).string()) == names.end()) return true;
  return is_there(directory) && !fs::is_directory(directory, error);
}

bool holds_steps(const fs::path& directory) {
  const fs::path series = directory / "series.csv";
  if (is_there(directory / "summary.json")) return true;
  if (!is_there(series)) return false;
  constexpr auto without_steps = 2;  // header and row of the reference state
  std::ifstream rows(series);
  return std::count(std::istreambuf_iterator<char>(rows), {}, '\n') > without_steps;
}

bool holds_ending(const fs::path& directory, bool with_report) {
  return is_there(directory / "summary.json") && (!with_report || is_there(directory / "report.html"));
}

void prepare_directory(const fs::path& directory, bool overwrite) {
  std::error_code error;
  if (is_there(directory) && !fs::is_directory(directory, error))
    throw FileError(directory.string() + ": is a file, not a directory; give another --out");
  if (holds_results(directory)) {
    if (!overwrite)
      throw FileError(directory.string() +
                      ": already contains results; give another --out, or --overwrite to replace them");
    for (const std::string& file : own_files) fs::remove(directory / file, error);
    remove_checkpoints(directory);
    remove_half_written(directory);
    // Remove snapshots only; other files belong to the user.
    for (const auto& entry : fs::directory_iterator(directory / "frames", error))
      if (is_frame(entry.path())) fs::remove(entry.path(), error);
  }
  make_directory(directory / "frames");
}

void remove_what_came_after(const fs::path& directory, std::size_t kept) {
  std::error_code ignored;
  for (std::size_t k = kept; fs::remove(directory / frame_file(k), ignored); ++k) continue;
  for (const char* file : {"summary.json", "report.html"}) fs::remove(directory / file, ignored);
}

}  // namespace plica
