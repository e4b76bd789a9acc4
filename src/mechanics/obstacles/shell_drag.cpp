#include "mechanics/obstacles/shell_drag.hpp"

namespace plica {

ShellDrag::ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag) : shell_(tissue, shell), drag_(drag) {
  add_areas(tissue, tissue.apical_facets, drag);
}

// Letters: F = -c/rate part (I - n n^T) d with displacement d; part and n depend on the position at the beginning.
void ShellDrag::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                   const BeginningGradient& gradient) const {
  for (std::size_t node = 0; node < coefficients_.size(); ++node)
    resist(step, node, [&](std::size_t, const Mat3& resistance) {
      gradient.add_before(node, resistance * adjoint[node]);
      const Obstacle::Gap gap = shell_.gap(step.previous_positions[node]);
      const double part = std::min(1.0, 1 - gap.value / film_um), c = coefficients_[node] / step.rate_s;
      const Vec3 &n = gap.inward, &mu = adjoint[node], d = moved(step, node);
      const double along = mu.dot(d) - mu.dot(n) * d.dot(n);
      if (gap.value > 0) gradient.previous[node] += c / film_um * along * n;
      gradient.previous[node] += c * part * (gap.hessian * (d.dot(n) * mu + mu.dot(n) * d));
    });
}

}  // namespace plica
