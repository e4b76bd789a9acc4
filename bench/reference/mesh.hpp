// The mesh files of the reference scene: bench/data/README.md.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

namespace plica::reference {

struct Spring {
  int i, j;
  double stiffness, damping, rest_length;
};

struct Mesh {
  std::vector<double> nodes;              // x y z of each
  std::vector<std::array<int, 8>> hexes;  // nodes 0-3 the inner quad counter-clockwise from outside, 4-7 the outer
  std::vector<Spring> springs;
};

/// Throws std::runtime_error with file and line where the file is not such a mesh.
Mesh read_mesh(const std::filesystem::path& file);

/// Positions of `count` nodes, x y z a line.
std::vector<double> read_positions(const std::filesystem::path& file, std::size_t count);

}  // namespace plica::reference
