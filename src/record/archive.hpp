// Named texts and lists of numbers in an HDF5 file, the basis of checkpoints. Without HDF5, plica has no checkpoints.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Whether this build has HDF5.
bool can_archive();

/// Datasets of a file by name.
struct Archive {
  std::map<std::string, std::string> texts;
  std::map<std::string, std::vector<double>> numbers;
};

/// Bytes of a file; equal archives give equal bytes. Throws FileError if HDF5 fails (no memory) or is missing.
std::string archive_bytes(const Archive& archive);

/// Replace the datasets of `archive` by those of their names in a file. Throws FileError, without a path, for another
/// file, a dataset that is missing or of another type, or numbers that are not finite.
void read_archive(std::string_view bytes, Archive& archive);

}  // namespace plica
