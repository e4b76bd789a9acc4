// What the fuzzers feed: each takes any bytes to one of plica's readers, and returns whether the reader took them as
// whole. Whatever else happens (a crash, another exception than a reader may throw, a result that breaks its promise)
// is a finding. docs/developers/hostile_input.md.
#pragma once

#include <string_view>

namespace plica {

/// A scenario's text. What stands behind "#! " at the start of a line is an override, as after --set.
bool fuzz_scenario(std::string_view bytes);

/// A mesh: the first byte says how often cells are divided, the rest is what the process that runs VTK's readers hands
/// over (tissue/files/mesh_bytes.hpp).
bool fuzz_mesh(std::string_view bytes);

/// Polygons: the first byte says in which format, OBJ ('o'), OFF ('f') or PLY, the rest is the file. What it holds is
/// mended and made a tissue.
bool fuzz_polygons(std::string_view bytes);

/// A checkpoint. The first byte says whether what follows is a whole file ('f'), or the HDF5 file in it ('h'), to which
/// the right checksum is added, so that damage gets beyond it.
bool fuzz_checkpoint(std::string_view bytes);

/// A study's text, its design where that is small, and the same bytes as a list of points and as experiments.
bool fuzz_study(std::string_view bytes);

}  // namespace plica
