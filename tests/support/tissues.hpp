// Tissues and motions that tests share.
#pragma once

#include "mechanics/law.hpp"
#include "support/testing.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica::support {

/// Numbers and vectors that are the same in every run.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Uniform in [-size, size].
  double number(double size = 1) { return std::uniform_real_distribution<double>(-size, size)(engine_); }
  Vec3 vector(double size = 1) {
    const double x = number(size), y = number(size), z = number(size);
    return {x, y, z};
  }
  Vectors vectors(std::size_t count, double size = 1) {
    Vectors result(count);
    for (Vec3& v : result) v = vector(size);
    return result;
  }
  Mat3 rotation();

 private:
  std::mt19937 engine_;
};

/// The same topology with other rest positions, and rest shapes to match.
Tissue with_rest_positions(Tissue tissue, Vectors positions);

/// A block whose nodes, inner and outer ones, are displaced at random by up to `size_um` in each direction.
Tissue distorted_block(const BlockShape& shape, double size_um, unsigned seed);

/// Two cells of one element, 20 um long and wide and 40 um high, in a row along x.
inline const BlockShape two_cells{.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}};

/// A tissue of one-element cells from their corners in VTK's order.
Tissue tissue_from_hexahedra(const std::vector<std::array<int, 8>>& hexahedra, Vectors positions);

/// A regular lattice of nx x ny x nz one-element cells whose nodes are placed by `place(i, j, k)`; node (i, j, k) has
/// number i + (nx + 1) (j + (ny + 1) k).
template <class Place>
Tissue mapped_lattice(int nx, int ny, int nz, const Place& place) {
  Vectors positions;
  for (int k = 0; k <= nz; ++k)
    for (int j = 0; j <= ny; ++j)
      for (int i = 0; i <= nx; ++i) positions.push_back(place(i, j, k));
  const auto node = [&](int i, int j, int k) { return i + (nx + 1) * (j + (ny + 1) * k); };
  std::vector<std::array<int, 8>> hexahedra;
  for (int k = 0; k < nz; ++k)
    for (int j = 0; j < ny; ++j)
      for (int i = 0; i < nx; ++i)
        hexahedra.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                             node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1),
                             node(i, j + 1, k + 1)});
  return tissue_from_hexahedra(hexahedra, std::move(positions));
}

/// All that a Step looks at.
struct Motion {
  Vectors positions, previous_positions, previous_velocities;
  double rate_s = 0.7;
  double end_time_s = 1.3;
  bool semidefinite_tangent = false;
  Vectors earlier_positions = {};
  double ahead = 0;
  std::vector<double> internal = {};  // of the law that is asked

  [[nodiscard]] Step step() const {
    return {.positions = positions,
            .previous_positions = previous_positions,
            .previous_velocities = previous_velocities,
            .rate_s = rate_s,
            .end_time_s = end_time_s,
            .semidefinite_tangent = semidefinite_tangent,
            .earlier_positions = earlier_positions,
            .ahead = ahead,
            .internal = internal};
  }
};

/// At rest since ever.
Motion at_rest(const Tissue& tissue);

/// The body under a uniform deformation gradient F from rest, without history.
Motion deformed(const Tissue& tissue, const Mat3& F);

/// Every node displaced at random by up to `size_um` in each direction at the beginning and at the end of the step, and
/// the whole turned by two different random rotations. Of second order with every other seed: then also at the
/// beginning of the step before.
Motion random_motion(const Tissue& tissue, double size_um, unsigned seed);

/// Largest length among vectors.
double largest(const Vectors& vectors);

/// How far two places of a node are apart, at most.
double largest_distance(std::span<const Vec3> one, std::span<const Vec3> other);

Vectors forces_of(const Law& law, const Step& step);

}  // namespace plica::support
