// What every command asks of an output file before it begins.
#pragma once

#include <filesystem>

namespace plica {

/// FileError when `file` is a directory, or is there already and `overwrite` is false.
void require_free(const std::filesystem::path& file, bool overwrite);

}  // namespace plica
