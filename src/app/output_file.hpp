// Check of an output file before a command starts.
#pragma once

#include <filesystem>

#include "core/errors.hpp"

namespace plica {

/// Throw FileError if `file` is a directory, or exists and `overwrite` is false.
inline void require_free(const std::filesystem::path& file, bool overwrite) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw FileError(file.string() + ": is a directory; give the name of a file");
  if (!overwrite && std::filesystem::exists(file, error))
    throw FileError(file.string() + ": already exists; give another --out, or --overwrite to replace it");
}

}  // namespace plica
