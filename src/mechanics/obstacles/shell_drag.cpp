#include "mechanics/obstacles/shell_drag.hpp"

#include "mechanics/energy.hpp"

namespace plica {

ShellDrag::ShellDrag(const Tissue& tissue, const OuterShape& shell, double drag)
    : shell_(tissue, shell), drag_(drag), coefficients_(tissue.node_count(), 0.0) {
  for (const Facet& facet : tissue.apical_facets)
    for (const NodeId node : facet.nodes)
      coefficients_[node.index()] += drag_ * facet_area(rest_corners(tissue, facet)) / 4;
}

std::unique_ptr<Law> ShellDrag::after_division(const Tissue& tissue, const Division&, std::span<const Vec3>) const {
  return std::make_unique<ShellDrag>(tissue, shell_.shell(), drag_);
}

std::unique_ptr<Law> ShellDrag::grown(const Tissue& tissue, std::span<const ElementId>) const {
  return std::make_unique<ShellDrag>(tissue, shell_.shell(), drag_);
}

// Calls take(node, resistance to a displacement in the step, nN/um) for the nodes that touch the shell as it begins.
template <class Take>
void ShellDrag::for_touching(const Step& step, const Take& take) const {
  for (std::size_t n = 0; n < coefficients_.size(); ++n) {
    if (coefficients_[n] == 0) continue;
    const Obstacle::Gap gap = shell_.gap(step.previous_positions[n]);
    if (gap.value >= film_um) continue;
    const double part = std::min(1.0, 1 - gap.value / film_um);
    const Mat3 along = Mat3::Identity() - gap.inward * gap.inward.transpose();
    take(n, Mat3(part * coefficients_[n] / step.rate_s * along));
  }
}

namespace {

Vec3 change(const Step& step, std::size_t node) {
  return step.positions[node] - step.before([node](std::span<const Vec3> x) { return x[node]; });
}

}  // namespace

double ShellDrag::energy(const Step& step) const {
  double sum = 0;
  for_touching(step, [&](std::size_t n, const Mat3& resistance) {
    const Vec3 moved = change(step, n);
    sum += 0.5 * moved.dot(resistance * moved);
  });
  return sum;
}

EnergyFlow ShellDrag::energy_flow(const MadeStep& made) const { return viscous_energy_flow(*this, made); }

void ShellDrag::add_forces(const Step& step, std::span<Vec3> forces) const {
  for_touching(step, [&](std::size_t n, const Mat3& resistance) { forces[n] -= resistance * change(step, n); });
}

void ShellDrag::add_tangent_product(const Step& step, std::span<const Vec3> direction, std::span<Vec3> product) const {
  for_touching(step, [&](std::size_t n, const Mat3& resistance) { product[n] += resistance * direction[n]; });
}

void ShellDrag::add_tangent(const Step& step, TangentSink& tangent) const {
  for_touching(step,
               [&](std::size_t n, const Mat3& resistance) { tangent.add_block(NodeId(n), NodeId(n), resistance); });
}

}  // namespace plica
