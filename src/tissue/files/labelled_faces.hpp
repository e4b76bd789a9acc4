// Meshes whose faces carry the number of their cell, such as triangles of MorphoGraphX.
#pragma once

#include <string>

#include "tissue/files/polygon_file.hpp"

namespace plica {

/// Join the faces of each label to one polygon, in order of labels; faces with label 0, less or NaN belong to no cell.
/// Its corners are the vertices where three cells, or two and the outside, meet. Arrays become means over the faces.
/// Cells with fewer than three corners are omitted, with a remark. MeshError if the file has no array of this name, a
/// cell is in pieces or has a hole, or none is left.
PolygonFile cells_of_labels(const PolygonFile& file, const std::string& label_array);

/// Return advice to name a label array, if all faces are triangles and an array numbers groups of them; else nothing.
std::string label_advice(const PolygonFile& file);

}  // namespace plica
