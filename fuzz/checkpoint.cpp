#include "record/checkpoint.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cmath>

#include "core/errors.hpp"
#include "targets.hpp"

namespace plica {
namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// HDF5 file followed by the trailer of a checkpoint (docs/how-to/reliability.md).
std::string with_checksum(std::string_view image) {
  std::string end = fmt::format("\nplica checkpoint {} bytes {} crc32 {:08x}", checkpoint_format, image.size(),
                                libdeflate_crc32(0, image.data(), image.size()));
  end.resize(63, ' ');
  return std::string(image) + end + "\n";
}

void check(const Checkpoint& checkpoint) {
  for (const Vec3& position : checkpoint.run.state.positions) require(position.allFinite());
  require(std::isfinite(checkpoint.run.state.time_s));
  require(fits_columns(checkpoint.run.measures));
}

}  // namespace

bool fuzz_checkpoint(std::string_view bytes) try {
  if (bytes.empty()) return false;
  const bool is_whole = bytes.front() == 'f';
  bytes.remove_prefix(1);
  check(is_whole ? read_checkpoint_bytes(bytes) : read_checkpoint_bytes(with_checksum(bytes)));
  return true;
} catch (const FileError&) {
  return false;
}

}  // namespace plica
