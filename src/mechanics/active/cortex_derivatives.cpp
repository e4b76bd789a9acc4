// Derivatives of the cortex for gradients of runs. Forces are -T dA/dx, so adjoint . forces is -T times the increase of
// the area along the adjoint. Letters as in docs/theory/cortex.md.
#include <algorithm>
#include <cmath>

#include "mechanics/active/cortex.hpp"

namespace plica {

const LawDerivatives& Cortex::derivatives() const {
  if (activation_.is_used())
    refuse_gradient("shape-dependent activity has no derivatives yet; remove its trigger or follow");
  if (rule_.walls.is_used())
    refuse_gradient("direction and noise of lateral faces have no derivatives yet; remove them");
  return *this;
}

// A central difference over 1e-3 um: its errors, of third derivatives and of rounding, are below 1e-9 for faces of
// cells.
std::vector<double> Cortex::area_increases(std::span<const Vec3> positions, std::span<const Vec3> direction) const {
  double largest = 0;
  for (const Vec3& vector : direction) largest = std::max(largest, vector.norm());
  std::vector<double> increases(faces_.size(), 0.0);
  if (largest == 0) return increases;
  const double size = 1e-3 / largest;
  Vectors ahead(positions.begin(), positions.end()), behind = ahead;
  for (std::size_t n = 0; n < ahead.size(); ++n) {
    ahead[n] += size * direction[n];
    behind[n] -= size * direction[n];
  }
  const std::vector<double> more = areas(ahead), less = areas(behind);
  for (std::size_t f = 0; f < increases.size(); ++f) increases[f] = (more[f] - less[f]) / (2 * size);
  return increases;
}

// With r = rate/tau and A_b the extrapolated rest area, T = k b (A - A_b)/(A_b + r A).
void Cortex::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                const BeginningGradient& gradient) const {
  if (!flows() || rule_.stiffness == 0) return;
  const std::vector<double> now = areas(step.positions), increases = area_increases(step.positions, adjoint);
  const double r = step.rate_s / rule_.relaxation_s;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double A = now[f], A_b = rest_area_before(f, step), yielding = A_b + r * A;
    const double k = rule_.stiffness * stiffening_of(f, step) * (A < A_b ? rule_.compression_ratio : 1);
    const double of_before = k * (1 + r) * A / (yielding * yielding) * increases[f] * rest_areas_[f];
    gradient.internal[f] += (1 + step.ahead) * of_before;
    gradient.internal[faces_.size() + f] -= step.ahead * of_before;
  }
}

void Cortex::add_internal_gradient(const Step& step, std::span<const double> /*next*/, std::span<const double> adjoint,
                                   std::span<Vec3> positions, const BeginningGradient& gradient) const {
  if (!flows()) return;
  const double r = step.rate_s / rule_.relaxation_s;
  // Forces of face tensions -w add sum w dA/dx.
  std::vector<double> tensions(places(), 0.0);
  const std::vector<double> no_slopes(places(), 0.0);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    tensions[f] = -r / ((1 + r) * rest_areas_[f]) * adjoint[f];
    gradient.internal[f] += (1 + step.ahead) / (1 + r) * adjoint[f] + adjoint[faces_.size() + f];
    gradient.internal[faces_.size() + f] -= step.ahead / (1 + r) * adjoint[f];
  }
  const FaceArrays at{batches_.data(), faces_.size(),    components(step.positions),
                      tensions.data(), no_slopes.data(), false};
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels().add_forces(at, first, last, components(positions)); });
}

void Cortex::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint, std::span<double> of_cells) const {
  const std::vector<double> now = areas(step.positions), increases = area_increases(step.positions, adjoint);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    const double A = now[f], saturation = rule_.saturation * rest_areas_[f], ratio = rest_areas_[f] / A;
    const double active = rule_.tension * A / (A + saturation), crowded = -rule_.crowding * ratio * ratio;
    const double elastic = rule_.stiffness == 0 ? 0 : this->elastic(f, A, step, 1, false).tension;
    const auto add = [&](CellId cell) {
      const double strength = pattern_.strengths[cell.index()];
      if (strength == 0) return;
      double tension = crowded;
      if (active != 0) tension += active * activity(cell, step.end_time_s, step.internal);
      if (elastic != 0) tension += elastic * stiffening(cell, step);
      of_cells[cell.index()] -= face.share * (face.beyond ? 0.5 : 1) * strength * tension * increases[f];
    };
    add(face.cell);
    if (face.beyond) add(*face.beyond);
  }
}

}  // namespace plica
