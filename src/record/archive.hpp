// Named arrays in the image of an HDF5 file: what a checkpoint is made of. Without HDF5, plica has no checkpoints.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Whether this build has HDF5.
bool can_archive();

/// Puts arrays into a file that is made in memory. Names are paths: "state/positions". An array of a name that is there
/// already takes its place: where it is as long as the one before that costs no more than copying it. FileError when
/// HDF5 cannot (no memory), or is not there; begin anew then.
class ArchiveWriter {
 public:
  ArchiveWriter();
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// `columns`: 0 for a list, else the length of the rows of a table.
  void put(const std::string& name, std::span<const double> values, std::size_t columns = 0);
  void put(const std::string& name, std::span<const int> values);
  void put(const std::string& name, std::span<const char> bytes);

  /// The file as it is now. Put once, the same arrays give the same bytes.
  [[nodiscard]] std::string image();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reads such a file from memory. FileError, without a path, for what is no such file, an array that is missing or of
/// another type, or numbers that are not finite.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view image);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  [[nodiscard]] std::vector<double> doubles(const std::string& name) const;
  [[nodiscard]] std::vector<int> integers(const std::string& name) const;
  [[nodiscard]] std::vector<char> bytes(const std::string& name) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace plica
