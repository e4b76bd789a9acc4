// What every command asks of an output file before it begins.
#pragma once

#include <filesystem>

#include "core/errors.hpp"

namespace plica {

/// FileError when `file` is a directory, or is there already and `overwrite` is false.
inline void require_free(const std::filesystem::path& file, bool overwrite) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw FileError(file.string() + ": is a directory; give the name of a file");
  if (!overwrite && std::filesystem::exists(file, error))
    throw FileError(file.string() + ": is there already; give another --out, or --overwrite to replace it");
}

}  // namespace plica
