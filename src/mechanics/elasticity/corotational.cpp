// Element data and the loop over elements. The formulas of forces and tangents are in
// corotational_lanes.hpp and corotational_kernels.cpp, which is compiled for several instruction sets.
#include "mechanics/elasticity/corotational.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "mechanics/elasticity/turning_elements.hpp"
#include "mechanics/energy.hpp"
#include "tissue/tissue_change.hpp"

namespace plica {
namespace {

constexpr std::size_t batch_size = ElementChunks::batch_size;

void put_stiffness(const Mat12& H, int lane, double (&stiffness)[78][batch_size]) {
  for (int row = 0; row < 12; ++row)
    for (int column = 0; column <= row; ++column) stiffness[row * (row + 1) / 2 + column][lane] = H(row, column);
}

void put_vector(const Vec3& v, int lane, double (&vectors)[3][batch_size]) {
  for (int axis = 0; axis < 3; ++axis) vectors[axis][lane] = v[axis];
}

}  // namespace

void nearest_rotation(const double (&F)[9], double (&R)[9]) {
  Mat3 rotation, stretch;
  polar(Mat3(F), rotation, stretch);
  Eigen::Map<Mat3>{R} = rotation;
}

Corotational::Corotational(const Tissue& tissue, std::vector<ElasticModuli> moduli, double shear_viscosity,
                           Kernels kernels)
    : BatchLaw(tissue.elements, {tissue, tissue.elements}, kernels),
      moduli_(tissue, std::move(moduli)),
      element_cell_(tissue.element_cell),
      shear_viscosity_(shear_viscosity),
      batches_(chunks_.batch_count()),
      viscous_batches_(shear_viscosity > 0 ? chunks_.batch_count() : 0) {
  require_upright_rest_shapes(tissue);
  parallel_for(
      places(), [&](std::size_t place) { fit(tissue, place); }, long_bodies);
}

void Corotational::fit(const Tissue& tissue, std::size_t place) {
  const std::size_t e = std::min(place, elements_.size() - 1);
  const int lane = static_cast<int>(place % batch_size);
  CorotationalBatch& batch = batches_[place / batch_size];
  for (int i = 0; i < 8; ++i) batch.nodes[i][lane] = 3 * elements_[e][i].number();

  const HexPoints& rest = tissue.element_rest_shape[e];
  const std::array<Vec3, 8> gradients = mean_gradients(rest);
  for (int mode = 0; mode < 6; ++mode) {
    Vec3 b = Vec3::Zero();
    for (int i = 0; i < 8; ++i) b += hex_modes[mode][i] / 8 * gradients[i];
    put_vector(b, lane, batch.gradients[mode]);
  }
  for (int a = 0; a < 4; ++a) {
    Vec3 X = Vec3::Zero();
    for (int i = 0; i < 8; ++i) X += hex_modes[3 + a][i] * rest[i];
    put_vector(X, lane, batch.hourglass[a]);
  }
  const double volume = hex_volume(rest);
  // Cells of a grid keep the gradients that their scenarios were calibrated with.
  const ModeGradients modes =
      tissue.cells[tissue.element_cell[e].index()].is_of_grid ? ModeGradients::by_centre : ModeGradients::by_points;
  const ElasticModuli moduli = strengths_.empty() ? moduli_[e] : strengths_[element_cell_[e].index()] * moduli_[e];
  batch.shear[lane] = 2 * moduli.shear_modulus * volume;
  put_stiffness(hourglass_stiffness(rest, moduli, modes), lane, batch.stiffness);
  if (viscous_batches_.empty()) return;
  ViscousBatch& viscous = viscous_batches_[place / batch_size];
  viscous.shear[lane] = 2 * shear_viscosity_ * volume;
  put_stiffness(hourglass_stiffness(rest, viscous_moduli(shear_viscosity_), modes), lane, viscous.stiffness);
}

CorotationalArrays Corotational::kernel_arrays(const Step& step) const {
  return {.batches = batches_.data(),
          .viscous_batches = viscous_batches_.empty() ? nullptr : viscous_batches_.data(),
          .elements = elements_.size(),
          .positions = components(step.positions),
          .previous_positions = components(step.previous_positions),
          .earlier_positions = components(step.earlier_positions),
          .ahead = step.ahead,
          .rate = 1 / step.rate_s,
          .semidefinite_tangent = step.semidefinite_tangent};
}

EnergyFlow Corotational::energy_flow(const CompletedStep& completed) const {
  return viscous_batches_.empty() ? Law::energy_flow(completed) : viscous_energy_flow(*this, completed);
}

std::vector<double> Corotational::energies(const CorotationalArrays& of_kernels) const {
  std::vector<double> energies(places());
  chunks_.for_batches(
      [&](std::size_t first, std::size_t last) { kernels().write_energies(of_kernels, first, last, energies.data()); });
  return energies;
}

double Corotational::energy(const Step& step) const {
  const std::vector<double> of_elements = energies(kernel_arrays(step));
  return chunks_.sum_over_elements([&](std::size_t e) { return of_elements[e]; });
}

// Minus the change of the elastic energy of each element along the adjoint, by central differences over 1e-3 um, which
// have errors below 1e-8 for elements of cells.
void Corotational::add_strength_gradient(const Step& step, std::span<const Vec3> adjoint,
                                         std::span<double> of_cells) const {
  double largest = 0;
  for (const Vec3& vector : adjoint) largest = std::max(largest, vector.norm());
  if (largest == 0) return;
  const double size = 1e-3 / largest;
  std::vector<Vec3> aside(adjoint.size());
  for (const double sign : {1.0, -1.0}) {
    for (std::size_t n = 0; n < aside.size(); ++n) aside[n] = step.positions[n] + sign * size * adjoint[n];
    CorotationalArrays at = kernel_arrays(step);
    at.positions = components(std::span<const Vec3>(aside));
    at.viscous_batches = nullptr;
    const std::vector<double> of_elements = energies(at);
    for (std::size_t e = 0; e < elements_.size(); ++e)
      of_cells[element_cell_[e].index()] -= sign / (2 * size) * of_elements[e];
  }
}

std::unique_ptr<Law> Corotational::with_strengths(std::span<const double> factors) const {
  auto law = std::make_unique<Corotational>(*this);
  law->strengths_.resize(factors.size(), 1.0);
  for (std::size_t c = 0; c < factors.size(); ++c) law->strengths_[c] *= factors[c];
  for (std::size_t place = 0; place < places(); ++place) {
    const double factor = factors[element_cell_[std::min(place, elements_.size() - 1)].index()];
    CorotationalBatch& batch = law->batches_[place / batch_size];
    batch.shear[place % batch_size] *= factor;
    for (auto& of_lanes : batch.stiffness) of_lanes[place % batch_size] *= factor;
  }
  return law;
}

// The integral over an element is -sum_i f_i x_i^T with the forces on its nodes when it is apart from all others.
void Corotational::add_stress_integrals(const Step& step, std::span<Mat3> of_cells) const {
  std::vector<CorotationalBatch> batches = batches_;
  for (std::size_t place = 0; place < places(); ++place)
    for (std::size_t i = 0; i < 8; ++i)
      batches[place / batch_size].nodes[i][place % batch_size] =
          static_cast<int>(3 * (8 * std::min(place, elements_.size() - 1) + i));
  Vectors positions, forces(8 * elements_.size(), Vec3::Zero());
  for (const Nodes& nodes : elements_)
    for (const NodeId node : nodes) positions.push_back(step.positions[node.index()]);
  CorotationalArrays apart = kernel_arrays(step);
  apart.batches = batches.data();
  apart.viscous_batches = nullptr;
  apart.positions = components(std::span<const Vec3>(positions));
  chunks_.for_batches([&](std::size_t first, std::size_t last) {
    kernels().add_forces(apart, first, last, components(std::span<Vec3>(forces)));
  });
  for (std::size_t k = 0; k < forces.size(); ++k)
    of_cells[element_cell_[k / 8].index()] -= forces[k] * positions[k].transpose();
}

std::unique_ptr<Law> Corotational::after_change(const Tissue& tissue, const TissueChange& change,
                                                std::span<const Vec3>) const {
  std::vector<ElasticModuli> moduli = moduli_.after_change(tissue, change);
  for (std::size_t e = 0; e < moduli.size() && !strengths_.empty(); ++e)
    moduli[e] = strengths_[change.origin[tissue.element_cell[e].index()].index()] * moduli[e];
  return std::make_unique<Corotational>(tissue, std::move(moduli), shear_viscosity_, kernels_);
}

}  // namespace plica
