// Derivatives of the cortex for gradients of runs. Forces are -T dA/dx, so adjoint . forces is -T times the increase of
// the area along the adjoint. Letters as in docs/theory/cortex.md.
#include <algorithm>
#include <cmath>

#include "mechanics/active/cortex.hpp"

namespace plica {

const LawDerivatives& Cortex::derivatives() const {
  if (reads_stress()) refuse_gradient("activity by stress has no derivative; use a measure of shape or a signal");
  if (rule_.activation.signal && activation_.starts())
    refuse_gradient("a trigger by a signal has no derivative yet; use follow");
  if (rule_.fibres.turn())
    refuse_gradient("fibres that turn with their cells have no derivative; set direction.axis to along or across");
  const bool jumps = (rule_.tension != 0 && rule_.program.at(0) != 0) || !rule_.program.jumps_s().empty() ||
                     !rule_.stiffness_program.jumps_s().empty();
  if (activation_.starts() && jumps)
    refuse_gradient(
        "a jump at a time given by a trigger has no derivative; let its program rise from activity 0, or start at a "
        "given time");
  return *this;
}

std::unique_ptr<Law> Cortex::smooth() const {
  if (!activation_.starts()) return {};
  auto law = std::make_unique<Cortex>(*this);
  law->rule_.activation.at_crossing = true;
  law->activation_.start_at_crossing();
  return law;
}

template <class Number>
std::span<Number> Cortex::activation_of(std::span<Number> internal) const {
  return internal.subspan(flows() ? 2 * faces_.size() : 0, activation_.is_used() ? pattern_.cells.size() : 0);
}

double Cortex::activity_slope(CellId cell, const Step& step, Height height) const {
  const Memory remembered = memory(step.internal);
  if (remembered.given.of(cell)) return 0;
  const double state = remembered.activation[cell.index()], time_s = step.end_time_s;
  const double factor = pattern_.remaining(cell, time_s, height) * pattern_.pulse(cell, time_s);
  if (!activation_.starts()) return factor * rule_.program.delayed_at(pattern_.delays_s[cell.index()], time_s);
  return state == ShapeActivation::not_yet ? 0 : -factor * rule_.program.slope_at(time_s - state);
}

double Cortex::stiffening_slope(CellId cell, const Step& step, Height height) const {
  const double start_s = memory(step.internal).activation[cell.index()];
  if (!activation_.starts() || start_s == ShapeActivation::not_yet) return 0;
  return -pattern_.remaining(cell, step.end_time_s, height) *
         rule_.stiffness_program.slope_at(step.end_time_s - start_s);
}

template <class Body>
void Cortex::for_cells(const Face& face, const Body& body) const {
  const double share = face.share * (face.beyond ? 0.5 : 1);
  const auto add = [&](CellId cell) {
    const double strength = pattern_.strengths[cell.index()];
    if (strength != 0) body(cell, share * strength);
  };
  add(face.cell);
  if (face.beyond) add(*face.beyond);
}

double Cortex::unit_tension(std::size_t f, double area) const {
  const double factor = rule_.walls.is_used() ? factors_.of_face[f] : 1;
  return factor * rule_.tension * area / (area + rule_.saturation * rest_areas_[f]);
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

void Cortex::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                const BeginningGradient& gradient) const {
  const bool is_elastic = flows() && rule_.stiffness != 0, has_direction = rule_.walls.direction && rule_.tension != 0;
  if (!is_elastic && !activation_.is_used() && !has_direction) return;
  take_factors(step);
  const Along along{step, areas(step.positions), area_increases(step.positions, adjoint)};
  if (is_elastic) add_flow_gradient(along, gradient);
  if (activation_.is_used()) add_activation_gradient(along, activation_of(gradient.internal));
  if (has_direction) add_direction_gradient(along, gradient.previous);
}

// With r = rate/tau and A_b the extrapolated rest area, T = k b (A - A_b)/(A_b + r A).
void Cortex::add_flow_gradient(const Along& along, const BeginningGradient& gradient) const {
  const Step& step = along.step;
  const double r = step.rate_s / rule_.relaxation_s;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double A = along.areas[f], A_b = rest_area_before(f, step), yielding = A_b + r * A;
    const double k = rule_.stiffness * stiffening_of(f, step) * (A < A_b ? rule_.compression_ratio : 1);
    const double of_before = k * (1 + r) * A / (yielding * yielding) * along.increases[f] * rest_areas_[f];
    gradient.internal[f] += (1 + step.ahead) * of_before;
    gradient.internal[faces_.size() + f] -= step.ahead * of_before;
  }
}

void Cortex::add_activation_gradient(const Along& along, std::span<double> of_states) const {
  const auto& [step, areas, increases] = along;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double active = unit_tension(f, areas[f]);
    const double elastic = rule_.stiffness == 0 ? 0 : this->elastic(f, areas[f], step, 1, false).tension;
    for_cells(faces_[f], [&](CellId cell, double weight) {
      double by_state = active == 0 ? 0 : active * activity_slope(cell, step, heights_[f]);
      if (elastic != 0) by_state += elastic * stiffening_slope(cell, step, heights_[f]);
      of_states[cell.index()] -= weight * by_state * increases[f];
    });
  }
}

void Cortex::add_direction_gradient(const Along& along, std::span<Vec3> previous) const {
  const auto& [direction, noise] = rule_.walls;
  const auto& [step, areas, increases] = along;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double acting = activity_of_face(f, step);
    const double by_noise = noise.spread > 0 ? noise_factor(noise, pairs_[f], step.end_time_s) : 1;
    const double by_direction =
        -by_noise * acting * rule_.tension * areas[f] / (areas[f] + rule_.saturation * rest_areas_[f]) * increases[f];
    const auto by_corner = direction_gradient(*direction, gather(step.previous_positions, faces_[f].nodes));
    for (int i = 0; i < 4; ++i) previous[faces_[f].nodes[i].index()] += by_direction * by_corner[i];
  }
}

std::vector<double> Cortex::next_internal_like(const Law& /*law*/, const Step& step,
                                               std::span<const double> next) const {
  std::vector<double> own = next_internal(step);
  if (activation_.is_used())
    std::ranges::copy(activation_.after_like(step, activation_of(step.internal), activation_of(next)),
                      activation_of(std::span(own)).begin());
  return own;
}

void Cortex::move_to_signals(std::span<double> by_internal, std::span<const CellArray> signals,
                             std::span<CellArray> by_signals) const {
  activation_.move_to_signals(activation_of(by_internal), signals, by_signals);
}

void Cortex::add_internal_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                                   std::span<Vec3> positions, const BeginningGradient& gradient) const {
  if (activation_.is_used()) {
    Step seen = step;
    seen.internal = activation_of(step.internal);
    activation_.add_gradient(seen, activation_of(next), activation_of(adjoint), positions,
                             {gradient.ahead, gradient.previous, gradient.earlier, activation_of(gradient.internal)});
    const std::span<const double> of_before = memory(adjoint).activation_before;
    for (std::size_t c = 0; c < of_before.size(); ++c) activation_of(gradient.internal)[c] += of_before[c];
  }
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
  const FaceArrays at{batches_.data(), fibres(),         faces_.size(), components(step.positions),
                      tensions.data(), no_slopes.data(), false};
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels().add_forces(at, first, last, components(positions)); });
}

void Cortex::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint, std::span<double> of_cells) const {
  take_factors(step);
  const std::vector<double> now = areas(step.positions), increases = area_increases(step.positions, adjoint);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const double A = now[f], ratio = rest_areas_[f] / A, active = unit_tension(f, A);
    const double elastic = rule_.stiffness == 0 ? 0 : this->elastic(f, A, step, 1, false).tension;
    for_cells(faces_[f], [&](CellId cell, double weight) {
      double tension = -rule_.crowding * ratio * ratio;
      if (active != 0) tension += active * activity(cell, step.end_time_s, step.internal, heights_[f]);
      if (elastic != 0) tension += elastic * stiffening(cell, step, heights_[f]);
      of_cells[cell.index()] -= weight * tension * increases[f];
    });
  }
}

// The area of a face changes by sum_i dA/dx_i . E x_i with a strain E. Each cell has its own layer of a lateral face.
void Cortex::add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const {
  if (rule_.stiffness == 0 && rule_.crowding == 0) return;
  const std::vector<double> now = areas(step.positions);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const std::array<Vec3, 4> corners = gather(step.positions, faces_[f].nodes),
                              gradient = facet_area_gradient(corners);
    Mat3 of_area = Mat3::Zero();
    for (int i = 0; i < 4; ++i) of_area += gradient[i] * corners[i].transpose();
    const double ratio = rest_areas_[f] / now[f];
    for_cells(faces_[f], [&](CellId cell, double weight) {
      double tension = -rule_.crowding * ratio * ratio;
      if (rule_.stiffness != 0) tension += elastic(f, now[f], step, stiffening(cell, step, heights_[f]), false).tension;
      of_cells[cell.index()] += weight * tension * of_area;
    });
  }
}

}  // namespace plica
