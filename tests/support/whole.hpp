// Whether the faces of a tissue close its cells.
#pragma once

#include "support/divided.hpp"
#include "tissue/faces.hpp"

namespace plica::support {

struct Counted {
  std::size_t lateral = 0, rims = 0;
  double rim_area = 0;  // um^2
};

/// What the faces of each cell enclose is its volume: by the cones from the origin over all faces, of lateral faces for
/// both their cells.
inline Counted expect_faces_enclose_the_cells(const Tissue& tissue) {
  std::vector<double> volumes(tissue.cells.size(), 0.0);
  Counted counted;
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral})
    for (const Face& face : faces_of(tissue, side)) {
      const double volume = cone(face.nodes, tissue.rest_positions);
      volumes[face.cell.index()] += volume;
      if (side != CellSide::lateral) continue;
      ++counted.lateral;
      if (face.beyond) {
        EXPECT_NE(*face.beyond, face.cell);
        volumes[face.beyond->index()] -= volume;
      } else {
        ++counted.rims;
        std::array<Vec3, 4> corners;
        for (int i = 0; i < 4; ++i) corners[i] = tissue.rest_positions[face.nodes[i].index()];
        counted.rim_area += facet_area(corners);
      }
    }
  for (std::size_t c = 0; c < volumes.size(); ++c)
    EXPECT_NEAR(volumes[c] / cell_volume(tissue, tissue.cells[c], tissue.rest_positions), 1, 1e-9) << "cell " << c;
  return counted;
}

}  // namespace plica::support
