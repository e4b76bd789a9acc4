// Tables of a vertex model in two dimensions of space or three: vertices, half-edges that run from one to the next
// about a face, and faces.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tissue/files/polygon_file.hpp"

namespace plica {

/// A table as pandas has it: a number for each row by which others name it, and named columns of numbers.
struct NumberedTable {
  std::vector<double> index;
  std::map<std::string, std::vector<double>> columns;
};

struct VertexModelTables {
  NumberedTable vertices;  // x, y and perhaps z
  NumberedTable edges;     // srce, trgt, face
  NumberedTable faces;     // whatever is known of them
};

/// Faces in the order of their table, its columns as arrays. Those without any edge are left out. MeshError when
/// columns are missing, a row is named that there is not, or the edges of a face are no ring.
PolygonFile polygons_of(const VertexModelTables& tables);

}  // namespace plica
