#include "support/tissues.hpp"

#include "tissue/lattice.hpp"

namespace plica::support {

Mat3 Random::rotation() {
  const Vec3 axis = vector().normalized();
  return Eigen::AngleAxisd(number(std::numbers::pi), axis).toRotationMatrix();
}

Tissue with_rest_positions(Tissue tissue, Vectors positions) {
  tissue.rest_positions = std::move(positions);
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    tissue.element_rest_shape[e] = gather(tissue.rest_positions, tissue.elements[e]);
  for (Cell& cell : tissue.cells)
    for (std::size_t i = 0; i < cell.corners.size(); ++i)
      cell.rest_shape[i] = tissue.rest_positions[cell.corners[i].index()];
  return tissue;
}

Tissue distorted_block(const BlockShape& shape, double size_um, unsigned seed) {
  Tissue block = build_block(shape);
  Random random(seed);
  Vectors positions = block.rest_positions;
  for (Vec3& x : positions) x += random.vector(size_um);
  return with_rest_positions(std::move(block), std::move(positions));
}

Tissue tissue_from_hexahedra(const std::vector<std::array<int, 8>>& hexahedra, Vectors positions) {
  std::vector<CellLattice> lattices;
  for (const auto& h : hexahedra) {
    CellLattice lattice;
    for (const int corner : {0, 1, 3, 2, 4, 5, 7, 6}) lattice.nodes.emplace_back(h[corner]);
    lattices.push_back(lattice);
  }
  return tissue_from_lattices(lattices, std::move(positions));
}

Motion at_rest(const Tissue& tissue) {
  return {tissue.rest_positions, tissue.rest_positions, Vectors(tissue.node_count(), Vec3::Zero())};
}

Motion deformed(const Tissue& tissue, const Mat3& F) {
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x = F * x;
  return motion;
}

Motion random_motion(const Tissue& tissue, double size_um, unsigned seed) {
  Random random(seed);
  Motion motion = at_rest(tissue);
  const auto move = [&](Vectors& positions) {
    const Mat3 rotation = random.rotation();
    const Vec3 shift = random.vector(50);
    for (Vec3& x : positions) x = rotation * (x + random.vector(size_um)) + shift;
  };
  move(motion.previous_positions);
  move(motion.positions);
  motion.previous_velocities = random.vectors(tissue.node_count(), 5);
  if (seed % 2 == 0) {
    motion.earlier_positions = tissue.rest_positions;
    move(motion.earlier_positions);
    motion.ahead = 0.4;
  }
  return motion;
}

double largest_distance(std::span<const Vec3> one, std::span<const Vec3> other) {
  EXPECT_EQ(one.size(), other.size());
  double most = 0;
  for (std::size_t n = 0; n < one.size(); ++n) most = std::max(most, (one[n] - other[n]).norm());
  return most;
}

double largest(const Vectors& vectors) {
  double result = 0;
  for (const Vec3& v : vectors) result = std::max(result, v.norm());
  return result;
}

Vectors forces_of(const Law& law, const Step& step) {
  Vectors forces(step.positions.size(), Vec3::Zero());
  law.add_forces(step, forces);
  return forces;
}

}  // namespace plica::support
