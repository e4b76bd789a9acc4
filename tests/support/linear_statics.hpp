// Linear statics with the laws' assembled tangent at rest: K u = f with some displacements prescribed.
#pragma once

#include "mechanics/elasticity/corotational.hpp"
#include "support/tissues.hpp"

namespace plica::support {

class LinearStatics {
 public:
  /// Elasticity alone, volumes not held: the mean volumetric part is Dilatation's. The tissue outlives it; what is
  /// prescribed and loaded are its free nodes.
  LinearStatics(const Tissue& tissue, const ElasticModuli& moduli);
  ~LinearStatics();
  LinearStatics(LinearStatics&& other) noexcept;

  /// The same from the elements' stiffness, for shapes that the laws refuse.
  static LinearStatics of_elements(const Tissue& tissue, const ElasticModuli& moduli);

  void prescribe(std::size_t node, int axis, double value) { prescribed_[3 * node + axis] = value; }
  void prescribe(std::size_t node, const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) prescribe(node, axis, value[axis]);
  }
  void add_load(std::size_t node, const Vec3& force) { loads_.segment<3>(3 * static_cast<int>(node)) += force; }
  void add_loads(const Vectors& forces) {
    for (std::size_t n = 0; n < forces.size(); ++n) add_load(n, forces[n]);
  }

  /// Displacements; prescribed ones as prescribed, hanging ones as the free ones say.
  [[nodiscard]] Vectors solve() const;

  /// K u - f: zero at free nodes, the supports' forces at the others.
  [[nodiscard]] Vectors reactions(const Vectors& displacements) const;

 private:
  explicit LinearStatics(const Tissue& tissue);

  struct Stiffness;  // a sparse matrix: its header is large
  const Tissue& tissue_;
  int size_;
  std::vector<std::optional<double>> prescribed_;
  Eigen::VectorXd loads_;
  std::unique_ptr<Stiffness> stiffness_;
};

}  // namespace plica::support
