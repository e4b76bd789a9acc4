#include "app/output_file.hpp"

#include "core/errors.hpp"

namespace plica {

void require_free(const std::filesystem::path& file, bool overwrite) {
  std::error_code error;
  if (std::filesystem::is_directory(file, error))
    throw FileError(file.string() + ": is a directory; give the name of a file");
  if (!overwrite && std::filesystem::exists(file, error))
    throw FileError(file.string() + ": is there already; give another --out, or --overwrite to replace it");
}

}  // namespace plica
