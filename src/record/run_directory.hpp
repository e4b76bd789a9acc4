// Directory of a run: names of its files, their removal, and checks for an earlier run.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace plica {

/// Path of a snapshot file (number from 0) within the directory.
std::string frame_file(std::size_t number);

/// Prepare `directory` for results; with `overwrite`, remove the files written by plica and no others. Throws FileError
/// if it cannot be created or written, or contains results and `overwrite` is false.
void prepare_directory(const std::filesystem::path& directory, bool overwrite);

/// Whether there is something else than a directory with files of these names, whole or temporary, at most.
bool holds_other_files(const std::filesystem::path& directory, std::span<const std::string_view> names);

/// Whether the directory contains steps: more than the files of a run that ended before its first checkpoint.
bool holds_steps(const std::filesystem::path& directory);

/// Whether all files written at the end of a run exist.
bool holds_ending(const std::filesystem::path& directory, bool with_report);

/// Final name of a temporary file (see write_beside); other names unchanged.
std::filesystem::path name_when_whole(const std::filesystem::path& name);

/// Remove temporary files of a killed run (see write_beside), only those of plica's own files.
void remove_half_written(const std::filesystem::path& directory);

/// Remove the snapshots after the first `kept` and the files written at the end of a run.
void remove_what_came_after(const std::filesystem::path& directory, std::size_t kept);

}  // namespace plica
