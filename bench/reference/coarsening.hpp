// Every second line of a layered mesh of hexahedra: the same shell with a quarter of the elements.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace plica::reference {

struct CoarseMesh {
  std::vector<std::array<int, 8>> hexes;  // of coarse nodes
  std::vector<int> kept;                  // the fine node that each coarse node is
  std::vector<int> starts, parents;       // parents[starts[n]] ...: coarse nodes whose mean fine node n is (1, 2 or 4)
};

/// Takes the mesh for layers of one quad surface (nodes 0-3 below 4-7), coarsened in the surface and not across it:
/// elements of a refined shell are flat no more, and it is along the surface that they are strongly coupled. Found from
/// the topology alone: from a corner where not four quads meet, two edges straight on, lies the next coarse vertex.
/// Nothing where that does not fit.
std::optional<CoarseMesh> coarsen(int nodes, std::span<const std::array<int, 8>> hexes);

}  // namespace plica::reference
