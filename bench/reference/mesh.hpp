// The mesh files of the reference scene: bench/data/README.md.
#pragma once

#include <array>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace plica::reference {

/// A file that is not what it should be; the message names file and line.
class FileError : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Spring {
  int i, j;
  double stiffness, damping, rest_length;
};

struct Mesh {
  std::vector<double> nodes;              // x y z of each
  std::vector<std::array<int, 8>> hexes;  // nodes 0-3 the inner quad counter-clockwise from outside, 4-7 the outer
  std::vector<Spring> springs;
};

/// Throws FileError with file and line where the file is not such a mesh.
Mesh read_mesh(const std::filesystem::path& file);

/// Positions of `count` nodes, x y z a line.
std::vector<double> read_positions(const std::filesystem::path& file, std::size_t count);

}  // namespace plica::reference
