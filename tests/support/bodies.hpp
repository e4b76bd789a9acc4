// Solid bodies of many layers of cells, whose last layer is apical: for tests of contact.
#pragma once

#include "support/testing.hpp"
#include "tissue/lattice.hpp"

namespace plica::support {

/// Bodies apart from each other, as one tissue of cells of one element.
class Bodies {
 public:
  /// A lattice of nx x ny x nz cells whose nodes lie at place(i, j, k); the faces k = nz are apical, k = 0 basal. Where
  /// its nodes begin: node (i, j, k) is that + i + (nx + 1) (j + (ny + 1) k).
  template <class Place>
  std::size_t add(const std::array<int, 3>& cells, const Place& place) {
    const std::size_t first = positions_.size();
    const auto [nx, ny, nz] = cells;
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) positions_.push_back(place(i, j, k));
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          CellLattice cell;
          cell.has_apical = k == nz - 1;
          cell.has_basal = k == 0;
          for (int corner = 0; corner < 8; ++corner)
            cell.nodes.emplace_back(
                first + static_cast<std::size_t>(i + corner % 2 +
                                                 (nx + 1) * (j + corner / 2 % 2 + (ny + 1) * (k + corner / 4))));
          cells_.push_back(cell);
        }
    return first;
  }
  [[nodiscard]] Tissue tissue() const { return tissue_from_lattices(cells_, positions_); }

 private:
  Vectors positions_;
  std::vector<CellLattice> cells_;
};

/// The contact law's push on the nodes from `first` on, nN.
inline Vec3 sum_from(const Vectors& forces, std::size_t first) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = first; n < forces.size(); ++n) sum += forces[n];
  return sum;
}

}  // namespace plica::support
