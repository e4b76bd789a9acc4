#include "record/checkpoint.hpp"

#include <fmt/format.h>
#include <libdeflate.h>

#include <cmath>

#include "core/errors.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
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

/// Model of which the seed `divided` is a run (BLOCK in make_corpus.py).
const Model& block() {
  static const std::unique_ptr<Model> model = make_model(load_scenario({"block", "block.toml", R"(format = 1
[embryo]
shape = "block"
length_um = 40
cells = [2, 2, 1]
[vitelline]
enabled = false
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
)"}));
  return *model;
}

void check(const Checkpoint& checkpoint) {
  for (const Vec3& position : checkpoint.run.state.positions) require(position.allFinite());
  require(std::isfinite(checkpoint.run.state.time_s));
  require(fits_columns(checkpoint.run.measures));
  if (!checkpoint.run.changes) return;
  try {
    const std::size_t nodes = checkpoint.run.state.positions.size();
    require(restored(block(), *checkpoint.run.changes, nodes).tissue.node_count() == nodes);
  } catch (const std::logic_error&) {  // does not fit
  }
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
