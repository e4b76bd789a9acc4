// Reading of tables of measured points, and of values per cell.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct PointTable {
  Vectors points;                                     // um; one per row
  std::map<std::string, std::vector<double>> arrays;  // other columns; NaN: no value
  std::vector<std::string> remarks = {};              // what was omitted
};

/// Parse a CSV table whose first line names its columns, including x_um, y_um and z_um. Empty fields, nan, na and null
/// are missing values; columns without a number are omitted. MeshError names the line and the problem.
PointTable points_in_csv(std::string_view text);
PointTable read_points_file(const std::filesystem::path& file);

/// Read a CSV table of numbers whose first line names its columns. Throws MeshError as above.
std::map<std::string, std::vector<double>> read_cell_table(const std::filesystem::path& file);

}  // namespace plica
