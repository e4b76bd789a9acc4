// Layout of tangents written by kernels of hexahedral elements.
#pragma once

namespace plica {

/// Tangents of eight elements, nN/um: 3 x 3 blocks, by columns, of the 36 pairs of corners (0,0), (1,0), (1,1), (2,0),
/// ...
struct alignas(64) HexahedronBlocks {
  double blocks[36][9][8];
};

}  // namespace plica
