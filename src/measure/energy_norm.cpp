#include "measure/energy_norm.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/elasticity/corotational.hpp"

namespace plica {

std::optional<double> relative_energy_norm(const RestMesh& mesh, double poisson_ratio, std::span<const Vec3> a,
                                           std::span<const Vec3> b) {
  const ElasticModuli moduli = ElasticModuli::from_young(1, poisson_ratio);
  double difference = 0, reference = 0, rounding = 0;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e) {
    if (!mesh.chosen.empty() && !mesh.chosen[e]) continue;
    Vec24 of_a, of_b;
    for (int i = 0; i < 8; ++i) {
      const std::size_t node = mesh.elements[e][i].index();
      of_a.segment<3>(3 * i) = a[node];
      of_b.segment<3>(3 * i) = b[node];
    }
    const Mat24 stiffness = incompatible_stiffness(mesh.rest_shapes[e], moduli);
    const Vec24 apart = of_a - of_b;
    difference += apart.dot(stiffness * apart);
    reference += of_b.dot(stiffness * of_b);
    rounding += 1e-13 * stiffness.trace() / 24 * of_b.squaredNorm();
  }
  if (!(reference > rounding)) return std::nullopt;  // undeformed, or moved rigidly
  return std::sqrt(std::max(0.0, difference) / reference);
}

}  // namespace plica
