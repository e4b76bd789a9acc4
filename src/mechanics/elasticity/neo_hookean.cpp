// Element data, energy, and relaxation of rest shapes. Forces and tangents are in
// neo_hookean_kernels.cpp.
#include "mechanics/elasticity/neo_hookean.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "mechanics/energy.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

constexpr std::size_t lanes = ElementChunks::batch_size;
constexpr std::size_t numbers_a_batch = 8 * 6 * lanes;
static_assert(sizeof(FlowedBatch) == numbers_a_batch * sizeof(double));

Vec3 gauss_point(int g) { return hex_reference_nodes[static_cast<std::size_t>(g)] / std::sqrt(3.0); }

// Gradients of the shape functions at a Gauss point.
const std::array<Vec3, 8>& gauss_gradients(int g) {
  static const std::array<std::array<Vec3, 8>, 8> gradients = [] {
    std::array<std::array<Vec3, 8>, 8> of_point;
    for (int point = 0; point < 8; ++point) of_point[point] = hex_shape_gradients(gauss_point(point));
    return of_point;
  }();
  return gradients[g];
}

// dx/d(reference) at a Gauss point: hex_jacobian there.
Mat3 gauss_jacobian(const HexPoints& points, int g) {
  Mat3 jacobian = Mat3::Zero();
  for (int i = 0; i < 8; ++i) jacobian += points[i] * gauss_gradients(g)[i].transpose();
  return jacobian;
}

std::span<FlowedBatch> batches_of(std::span<double> internal) {
  return {reinterpret_cast<FlowedBatch*>(internal.data()), internal.size() / numbers_a_batch};
}

// First number of a Gauss point of an element; the next is `lanes` further.
template <class Batches>
auto* first_of(const Batches& batches, std::size_t place, int g) {
  return &batches[place / lanes].points[g][0][place % lanes];
}

void put(const Mat3& symmetric, double* first) {
  const double values[6] = {symmetric(0, 0), symmetric(1, 1), symmetric(2, 2),
                            symmetric(0, 1), symmetric(1, 2), symmetric(2, 0)};
  for (std::size_t k = 0; k < 6; ++k) first[k * lanes] = values[k];
}

Mat3 symmetric_at(const double* first) {
  const auto at = [&](std::size_t k) { return first[k * lanes]; };
  Mat3 result;
  result << at(0), at(3), at(5), at(3), at(1), at(4), at(5), at(4), at(2);
  return result;
}

// Gradients of a function by the six numbers of a symmetric matrix, from its symmetric gradient G by the matrix, so
// that it changes by tr(G dM); and the reverse.
void add_by_numbers(const Mat3& G, double factor, double* first) {
  const double values[6] = {G(0, 0), G(1, 1), G(2, 2), 2 * G(0, 1), 2 * G(1, 2), 2 * G(2, 0)};
  for (std::size_t k = 0; k < 6; ++k) first[k * lanes] += factor * values[k];
}

Mat3 by_matrix(const double* first) {
  Mat3 G = 0.5 * symmetric_at(first);
  G.diagonal() *= 2;
  return G;
}

Mat3 deformation_gradient(const HexPoints& points, const HexPoints& rest, int g) {
  return gauss_jacobian(points, g) * gauss_jacobian(rest, g).inverse();
}

}  // namespace

NeoHookean::NeoHookean(const Tissue& tissue, std::vector<NeoHookeanMaterial> materials, Kernels kernels)
    : BatchLaw(tissue.elements, {tissue, tissue.elements}, kernels),
      materials_(tissue, materials),
      flows_(std::ranges::any_of(materials, [](const NeoHookeanMaterial& one) { return one.relaxation_s > 0; })),
      element_cell_(tissue.element_cell),
      rest_(tissue.element_rest_shape),
      batches_(chunks_.batch_count()),
      flow_batches_(flows_ ? chunks_.batch_count() : 0) {
  require_upright_rest_shapes(tissue);
  parallel_for(places(), [&](std::size_t place) { fit(tissue, place); });
}

void NeoHookean::fit(const Tissue& tissue, std::size_t place) {
  const std::size_t e = std::min(place, elements_.size() - 1), lane = place % batch_size;
  if (place == e) rest_[e] = tissue.element_rest_shape[e];
  NeoHookeanBatch& batch = batches_[place / batch_size];
  for (int i = 0; i < 8; ++i) batch.nodes[i][lane] = 3 * elements_[e][i].number();
  const auto& [shear_modulus, relaxation_s] = materials_[e];
  const double strength = strengths_.empty() ? 1 : strengths_[element_cell_[e].index()];
  for (int g = 0; g < 8; ++g) {
    const Mat3 D0 = gauss_jacobian(tissue.element_rest_shape[e], g);
    batch.weights[g][lane] = strength * shear_modulus * D0.determinant();
    put((D0.transpose() * D0).inverse(), &batch.metrics[g][0][lane]);
    if (!flows_) continue;
    for (int k = 0; k < 9; ++k) flow_batches_[place / batch_size].frames[g][k][lane] = D0.data()[k];
  }
  if (flows_) flow_batches_[place / batch_size].rates[lane] = relaxation_s > 0 ? 1 / relaxation_s : 0;
}

NeoHookean::Memory NeoHookean::memory(std::span<const double> internal) const {
  if (!flows_) return {};
  const auto* first = reinterpret_cast<const FlowedBatch*>(internal.data());
  return {{first, batches_.size()}, {first + batches_.size(), batches_.size()}};
}

NeoHookeanArrays NeoHookean::kernel_arrays(const Step& step) const {
  const auto [now, earlier] = memory(step.internal);
  return {.batches = batches_.data(),
          .flows = flows_ ? flow_batches_.data() : nullptr,
          .elements = elements_.size(),
          .positions = components(step.positions),
          .semidefinite_tangent = step.semidefinite_tangent,
          .flowed = now.data(),
          .flowed_earlier = earlier.data(),
          .ahead = step.ahead,
          .rate_s = step.rate_s};
}

Mat3 NeoHookean::flowed(std::span<const double> internal, ElementId element, int g) const {
  return symmetric_at(first_of(memory(internal).now, element.index(), g));
}

Mat3 NeoHookean::flowed_before(std::size_t e, int g, const Step& step) const {
  const auto [now, earlier] = memory(step.internal);
  return step.extrapolated(symmetric_at(first_of(now, e, g)), symmetric_at(first_of(earlier, e, g)));
}

double NeoHookean::energy(const Step& step) const {
  return chunks_.sum_over_elements([&](std::size_t e) {
    const HexPoints points = gather(step.positions, elements_[e]);
    double sum = 0;
    for (int g = 0; g < 8; ++g) {
      const double weight = batches_[e / batch_size].weights[g][e % batch_size];
      const Mat3 F = deformation_gradient(points, rest_[e], g), C = F.transpose() * F;
      const double J = F.determinant();
      if (!(J > 0)) return std::numeric_limits<double>::infinity();
      const double r = flows_ ? step.rate_s * flow_batches_[e / batch_size].rates[e % batch_size] : 0;
      double stored = 0.5 * C.trace();
      if (r > 0) {
        // 3 det(C_b + r C)^(1/3)/2 r, minus terms independent of C.
        const Mat3 before = flowed_before(e, g, step), A = before.inverse() * C;
        const double I1 = A.trace(), I2 = 0.5 * (I1 * I1 - (A * A).trace()), I3 = A.determinant();
        stored = 1.5 * std::cbrt(before.determinant()) * std::expm1(std::log1p(r * (I1 + r * (I2 + r * I3))) / 3) / r;
      }
      sum += weight * (stored - 1.5 - std::log(J));
    }
    return sum;
  });
}

EnergyFlow NeoHookean::energy_flow(const CompletedStep& completed) const {
  return flows_ ? relaxing_energy_flow(*this, completed) : Law::energy_flow(completed);
}

std::vector<double> NeoHookean::first_internal(const Tissue& /*tissue*/) const {
  if (!flows_) return {};
  std::vector<double> internal(2 * batches_.size() * numbers_a_batch);
  for (std::size_t first = 0; first < internal.size(); first += 6 * batch_size)
    for (std::size_t lane = 0; lane < batch_size; ++lane) put(Mat3::Identity(), &internal[first + lane]);
  return internal;
}

std::vector<double> NeoHookean::next_internal(const Step& step) const {
  if (!flows_) return {};
  const std::size_t size = batches_.size() * numbers_a_batch;
  std::vector<double> internal(2 * size);
  std::copy_n(step.internal.begin(), size, internal.begin() + static_cast<std::ptrdiff_t>(size));
  const NeoHookeanArrays at = kernel_arrays(step);
  chunks_.for_batches([&](std::size_t first, std::size_t last) {
    kernels().write_flowed(at, first, last, batches_of(internal).data());
  });
  return internal;
}

NeoHookean::FlowingPoint NeoHookean::flowing_point(std::size_t place, int g, const Step& step) const {
  const std::size_t e = std::min(place, elements_.size() - 1);
  const Mat3 to_rest = gauss_jacobian(rest_[e], g).inverse();
  const Mat3 F = gauss_jacobian(gather(step.positions, elements_[e]), g) * to_rest;
  const double r = step.rate_s * flow_batches_[place / batch_size].rates[place % batch_size];
  return {F, to_rest, flowed_before(place, g, step) + r * F.transpose() * F, r};
}

void NeoHookean::add_by_flowed(const Mat3& by_flowed, std::size_t place, int g,
                               const BeginningGradient& gradient) const {
  const std::span<FlowedBatch> now = batches_of(gradient.internal), earlier = now.subspan(batches_.size());
  add_by_numbers(by_flowed, 1 + gradient.ahead, first_of(now, place, g));
  add_by_numbers(by_flowed, -gradient.ahead, first_of(earlier, place, g));
}

// With S = C_b + r C and d = det(S)^(1/3), adjoint . forces has the term -w/2 tr(dC d S^-1), dC along the adjoint.
void NeoHookean::add_force_gradient(const Step& step, std::span<const Vec3> adjoint,
                                    const BeginningGradient& gradient) const {
  if (!flows_) return;
  chunks_.for_elements([&](std::size_t e) {
    const HexPoints along = gather(adjoint, elements_[e]);
    for (int g = 0; g < 8; ++g) {
      const auto [F, to_rest, S, r] = flowing_point(e, g, step);
      const Mat3 half = F.transpose() * gauss_jacobian(along, g) * to_rest, dC = half + half.transpose();
      const Mat3 inverse = S.inverse(), turned = inverse * dC * inverse;
      const double factor = -0.5 * batches_[e / batch_size].weights[g][e % batch_size] * std::cbrt(S.determinant());
      add_by_flowed(factor * ((inverse * dC).trace() / 3 * inverse - turned), e, g, gradient);
    }
  });
}

// Changes of S/d along Z are tr(Q dS), Q = (Z - tr(Z S)/3 S^-1)/d; dS = dC_b + r dC.
void NeoHookean::add_internal_gradient(const Step& step, std::span<const double> /*next*/,
                                       std::span<const double> adjoint, std::span<Vec3> positions,
                                       const BeginningGradient& gradient) const {
  if (!flows_) return;
  const auto [of_now, of_earlier] = memory(adjoint);
  const auto add = [&](std::size_t place) {
    const std::array<NodeId, 8>& nodes = elements_[std::min(place, elements_.size() - 1)];
    for (int g = 0; g < 8; ++g) {
      const auto [F, to_rest, S, r] = flowing_point(place, g, step);
      const Mat3 Z = by_matrix(first_of(of_now, place, g));
      const Mat3 Q = (Z - (Z * S).trace() / 3 * S.inverse()) / std::cbrt(S.determinant());
      add_by_flowed(Q, place, g, gradient);
      add_by_numbers(by_matrix(first_of(of_earlier, place, g)), 1, first_of(batches_of(gradient.internal), place, g));
      const Mat3 by_jacobian = 2 * r * F * Q * to_rest.transpose();
      for (int i = 0; i < 8; ++i) positions[nodes[i].index()] += by_jacobian * gauss_gradients(g)[i];
    }
  };
  chunks_.for_elements(add);
  for (std::size_t place = elements_.size(); place < places(); ++place) add(place);
}

// A Gauss point has -w (d tr(S^-1 dC)/2 - tr(F^-1 dF)), and -w (tr(dC)/2 - tr(F^-1 dF)) if it does not flow, where dF
// and dC are along the adjoint.
void NeoHookean::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                                       std::span<double> of_cells) const {
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    const HexPoints points = gather(step.positions, elements_[e]), along = gather(adjoint, elements_[e]);
    for (int g = 0; g < 8; ++g) {
      const Mat3 to_rest = gauss_jacobian(rest_[e], g).inverse();
      const Mat3 F = gauss_jacobian(points, g) * to_rest, dF = gauss_jacobian(along, g) * to_rest;
      const Mat3 half = F.transpose() * dF;
      double energy = half.trace();
      if (flows_ && flow_batches_[e / batch_size].rates[e % batch_size] > 0) {
        const Mat3 S = flowing_point(e, g, step).sum;
        energy = std::cbrt(S.determinant()) * (S.inverse() * half).trace();
      }
      energy -= (F.inverse() * dF).trace();
      of_cells[element_cell_[e].index()] -= batches_[e / batch_size].weights[g][e % batch_size] * energy;
    }
  }
}

std::unique_ptr<Law> NeoHookean::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<NeoHookean>(*this);
  law->strengths_.resize(factors.size(), 1.0);
  for (std::size_t c = 0; c < factors.size(); ++c) law->strengths_[c] *= factors[c];
  for (std::size_t place = 0; place < places(); ++place)
    for (int g = 0; g < 8; ++g)
      law->batches_[place / batch_size].weights[g][place % batch_size] *=
          factors[element_cell_[std::min(place, elements_.size() - 1)].index()];
  return law;
}

std::unique_ptr<Law> NeoHookean::after_change(const Tissue& tissue, const TissueChange& change,
                                              std::span<const Vec3>) const {
  std::vector<NeoHookeanMaterial> materials = materials_.after_change(tissue, change);
  for (std::size_t e = 0; e < materials.size() && !strengths_.empty(); ++e)
    materials[e].shear_modulus *= strengths_[change.origin[tissue.element_cell[e].index()].index()];
  return std::make_unique<NeoHookean>(tissue, std::move(materials), kernels_);
}

std::optional<Mat3> NeoHookean::elastic_stretch(std::span<const double> internal, std::span<const Vec3> positions,
                                                std::span<const ElementId> elements) const {
  Stretches all;
  for (const ElementId id : elements) add_stretches(internal, positions, id, all);
  return Mat3(all.sum / all.weights);
}

void NeoHookean::add_stretches(std::span<const double> internal, std::span<const Vec3> positions, ElementId element,
                               Stretches& stretches) const {
  const std::size_t e = element.index();
  const HexPoints points = gather(positions, elements_[e]);
  for (int g = 0; g < 8; ++g) {
    const double weight = batches_[e / batch_size].weights[g][e % batch_size];
    const Mat3 F = deformation_gradient(points, rest_[e], g);
    stretches.sum +=
        weight * F * (flows_ ? flowed(internal, element, g).inverse() : Mat3(Mat3::Identity())) * F.transpose();
    stretches.weights += weight;
  }
}

// The Kirchhoff stress is mu (F C_p^-1 F^T - I).
void NeoHookean::add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const {
  std::vector<Stretches> of_elements(elements_.size());
  chunks_.for_elements(
      [&](std::size_t e) { add_stretches(step.internal, step.positions, ElementId(e), of_elements[e]); });
  for (std::size_t e = 0; e < elements_.size(); ++e)
    of_cells[element_cell_[e].index()] += of_elements[e].sum - of_elements[e].weights * Mat3::Identity();
}

std::vector<double> NeoHookean::internal_after_change(std::span<const double> internal, const Tissue& tissue,
                                                      const TissueChange& change, const ChangePositions&) const {
  if (!flows_) return {};
  std::vector<std::vector<std::size_t>> of_cell(std::ranges::max(element_cell_).index() + 1);  // elements before
  for (std::size_t e = 0; e < elements_.size(); ++e) of_cell[element_cell_[e].index()].push_back(e);
  const auto where = [](const HexPoints& rest, int g) {
    const std::array<double, 8> shape = hex_shape(gauss_point(g));
    Vec3 x = Vec3::Zero();
    for (int i = 0; i < 8; ++i) x += shape[i] * rest[i];
    return x;
  };
  // Gauss point of the cell before that is nearest in the reference state. Exchanges leave the elements of other cells.
  const auto origin_of = [&](std::size_t e, int g) {
    const CellId cell = tissue.element_cell[e];
    const std::vector<std::size_t>& before = of_cell[change.origin[cell.index()].index()];
    if (!change.remeshed.empty()) return std::pair(before[e - tissue.cells[cell.index()].first_element.index()], g);
    const Vec3 x = where(tissue.element_rest_shape[e], g);
    double least = std::numeric_limits<double>::infinity();
    std::pair<std::size_t, int> nearest;
    for (const std::size_t old : before)
      for (int h = 0; h < 8; ++h)
        if (const double distance = (where(rest_[old], h) - x).squaredNorm(); distance < least) {
          least = distance;
          nearest = {old, h};
        }
    return nearest;
  };
  const std::size_t count = tissue.elements.size(), batches = (count + batch_size - 1) / batch_size;
  std::vector<double> after(2 * batches * numbers_a_batch);
  const auto [now, earlier] = memory(internal);
  const std::span<FlowedBatch> now_after = batches_of(after), earlier_after = now_after.subspan(batches);
  for (std::size_t place = 0; place < batches * batch_size; ++place)
    for (int g = 0; g < 8; ++g) {
      const std::size_t e = std::min(place, count - 1);
      if (change.is_remeshed(tissue.element_cell[e])) {
        for (const std::span<FlowedBatch> batch : {now_after, earlier_after})
          put(Mat3::Identity(), first_of(batch, place, g));
        continue;
      }
      const auto [from, h] = origin_of(e, g);
      put(symmetric_at(first_of(now, from, h)), first_of(now_after, place, g));
      put(symmetric_at(first_of(earlier, from, h)), first_of(earlier_after, place, g));
    }
  return after;
}

}  // namespace plica
