// Tables of a vertex model in two or three dimensions: vertices, half-edges along the outline of a face, and faces.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tissue/files/polygon_file.hpp"

namespace plica {

/// Table as in pandas: an index number per row, and named numeric columns.
struct NumberedTable {
  std::vector<double> index;
  std::map<std::string, std::vector<double>> columns;
};

struct VertexModelTables {
  NumberedTable vertices;  // x, y and optionally z
  NumberedTable edges;     // srce, trgt, face
  NumberedTable faces;     // any columns
};

/// Return faces in the order of their table, with its columns as arrays; faces without edges are omitted. MeshError if
/// columns or referenced rows are missing, or the edges of a face do not form one ring. Edges of a ring that run
/// against most others are reversed.
PolygonFile polygons_of(const VertexModelTables& tables);

}  // namespace plica
