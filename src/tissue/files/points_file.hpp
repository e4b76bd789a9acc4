// Tables of measured points.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct PointTable {
  Vectors points;                                     // um; a row each
  std::map<std::string, std::vector<double>> arrays;  // the other columns of numbers
};

/// A table in CSV whose first line names its columns, x_um, y_um and z_um among them. MeshError names the line and what
/// is wrong with it.
PointTable points_in_csv(std::string_view text);
PointTable read_points_file(const std::filesystem::path& file);

}  // namespace plica
