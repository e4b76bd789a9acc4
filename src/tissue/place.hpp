// Positions in messages.
#pragma once

#include <string>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

struct HexahedralMesh;
struct Tissue;

/// Return "(1.5, 0, -20) um".
std::string place_text(const Vec3& place);

/// Return "cell 12 at (1.5, 0, -20) um": the centre in the reference state, or the mean of its nodes.
std::string cell_at(const Tissue& tissue, CellId cell);
std::string cell_at(const HexahedralMesh& mesh, std::size_t cell);

}  // namespace plica
