// Replacement of archive_hdf5.cpp for builds without HDF5.
#ifndef PLICA_WITH_HDF5

#include "core/errors.hpp"
#include "record/archive.hpp"

namespace plica {
namespace {

[[noreturn]] void refuse() { throw FileError("this build has no checkpoints (built without HDF5)"); }

}  // namespace

struct ArchiveWriter::File {};
struct ArchiveReader::File {};

bool can_archive() { return false; }

ArchiveWriter::ArchiveWriter() { refuse(); }
ArchiveWriter::~ArchiveWriter() = default;
void ArchiveWriter::put(const std::string&, std::span<const double>, std::size_t) {}
void ArchiveWriter::put(const std::string&, std::span<const int>) {}
void ArchiveWriter::put(const std::string&, std::span<const char>) {}
std::string ArchiveWriter::image() { return {}; }

ArchiveReader::ArchiveReader(std::string_view) { refuse(); }
ArchiveReader::~ArchiveReader() = default;
bool ArchiveReader::has(const std::string&) const { return false; }
std::vector<double> ArchiveReader::doubles(const std::string&) const { return {}; }
std::vector<int> ArchiveReader::integers(const std::string&) const { return {}; }
std::vector<char> ArchiveReader::bytes(const std::string&) const { return {}; }

}  // namespace plica

#endif
