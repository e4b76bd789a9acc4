// Fuzz targets: each passes bytes to one of plica's readers and returns whether it accepted them. A crash, an
// unexpected exception or an inconsistent result is a finding. See docs/developers/hostile_input.md.
#pragma once

#include <string_view>

namespace plica {

/// Text of a scenario. Lines after "#! " are overrides, as after --set.
bool fuzz_scenario(std::string_view bytes);

/// Mesh: the first byte is the number of divisions, the rest the output of the process with VTK's readers
/// (tissue/files/child_reading.hpp).
bool fuzz_mesh(std::string_view bytes);

/// Polygons: the first byte is the format, OBJ ('o'), OFF ('f') or PLY, the rest the file, which is repaired and built
/// into a tissue.
bool fuzz_polygons(std::string_view bytes);

/// Checkpoint: the first byte selects a complete file ('f'), or its HDF5 part ('h'), to which a valid checksum is added
/// so that damage passes it.
bool fuzz_checkpoint(std::string_view bytes);

/// Text of a study, its design if small, and the same bytes as a list of points and as experiments.
bool fuzz_study(std::string_view bytes);

}  // namespace plica
