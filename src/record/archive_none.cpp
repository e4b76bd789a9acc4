// Replacement of archive_hdf5.cpp for builds without HDF5.
#ifndef PLICA_WITH_HDF5

#include "core/errors.hpp"
#include "record/archive.hpp"

namespace plica {
namespace {

[[noreturn]] void refuse() { throw FileError("this build has no checkpoints (built without HDF5)"); }

}  // namespace

bool can_archive() { return false; }
std::string archive_bytes(const Archive&) { refuse(); }
void read_archive(std::string_view, Archive&) { refuse(); }

}  // namespace plica

#endif
