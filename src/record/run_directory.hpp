// The directory of a run: what plica writes there, what it may remove, and what it finds there of an earlier run.
#pragma once

#include <filesystem>
#include <string>

namespace plica {

/// The file of the frame of this number, from 0, within the directory.
std::string frame_file(std::size_t number);

/// Makes `directory` ready for results. Throws FileError when it cannot be made or written to, or when it holds results
/// and `overwrite` is false. With `overwrite`, removes the files that plica writes and nothing else.
void prepare_directory(const std::filesystem::path& directory, bool overwrite);

/// Whether it holds more than what a run leaves that ended before its first checkpoint, which is of no use to anyone.
bool holds_steps(const std::filesystem::path& directory);

/// Whether everything is there that the end of a run leaves.
bool holds_ending(const std::filesystem::path& directory, bool with_report);

/// The name of the file that was being written under a temporary name (see write_beside); any other name as it is.
std::filesystem::path name_when_whole(const std::filesystem::path& name);

/// What was being written when a run was killed. Only temporary names of plica's own files (see write_beside).
void remove_half_written(const std::filesystem::path& directory);

/// Removes the frames that come after the first `kept`, and what told of a run's end.
void remove_what_came_after(const std::filesystem::path& directory, std::size_t kept);

}  // namespace plica
