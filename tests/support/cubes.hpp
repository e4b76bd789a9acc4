// Patterns of boxes of nodes.
#pragma once

#include "support/testing.hpp"

namespace plica::support {

/// The eight nodes of every cube of a box of nodes, which are numbered along x, then y, then z.
inline std::vector<int> cubes_of_box(int nx, int ny, int nz) {
  std::vector<int> nodes;
  for (int z = 0; z + 1 < nz; ++z)
    for (int y = 0; y + 1 < ny; ++y)
      for (int x = 0; x + 1 < nx; ++x)
        for (int corner = 0; corner < 8; ++corner)
          nodes.push_back((x + (corner & 1)) + nx * ((y + (corner >> 1 & 1)) + ny * (z + (corner >> 2))));
  return nodes;
}

}  // namespace plica::support
