// Letters as in docs/theory/shape_memory.md: X_i rest points from their mean, Q = sum X_i X_i^T with eigenvalues q, V
// volume, u_i a node's distance from its place in the attractor, in the attractor's frame, s_i = sqrt(|u_i|^2 + e^2).
#include "mechanics/elasticity/shape_memory.hpp"

#include <cmath>

#include "core/parallel.hpp"
#include "mechanics/elasticity/corotational.hpp"

namespace plica {
namespace {

Mat3 spread(const HexPoints& rest) {
  Vec3 centre = Vec3::Zero();
  for (const Vec3& point : rest) centre += point / 8;
  Mat3 Q = Mat3::Zero();
  for (const Vec3& point : rest) Q += (point - centre) * (point - centre).transpose();
  return Q;
}

// Part without translation: eight vectors minus their mean.
Vec24 without_mean(const Vec24& vectors) {
  Vec3 mean = Vec3::Zero();
  for (int i = 0; i < 8; ++i) mean += vectors.segment<3>(3 * i) / 8;
  Vec24 result;
  for (int i = 0; i < 8; ++i) result.segment<3>(3 * i) = vectors.segment<3>(3 * i) - mean;
  return result;
}

}  // namespace

AttractorModuli attractor_moduli(const HexPoints& rest, double stiffness) {
  const Vec3 q = Eigen::SelfAdjointEigenSolver<Mat3>(spread(rest), Eigen::EigenvaluesOnly).eigenvalues();
  const double factor = stiffness / hex_volume(rest);
  AttractorModuli moduli;
  for (int i = 0; i < 3; ++i) {
    const double a = q[(i + 1) % 3], b = q[(i + 2) % 3];
    moduli.uniaxial[i] = factor * q[i];
    moduli.shear[i] = factor * a * b / (a + b);
  }
  return moduli;
}

ShapeMemory::ShapeMemory(const Tissue& tissue, const AttractorSprings& springs, double shear_viscosity)
    : TurningElements(tissue, shear_viscosity > 0),
      springs_(springs),
      shear_viscosity_(shear_viscosity),
      stiffness_(tissue.elements.size()),
      preload_(tissue.elements.size()) {
  parallel_for(
      elements_.size(), [&](std::size_t e) { fit(tissue, e); }, long_bodies);
}

void ShapeMemory::fit(const Tissue& tissue, std::size_t e) {
  take_rest_shape(tissue, e);
  const HexPoints& rest = tissue.element_rest_shape[e];
  Element& element = elements_[e];
  // The frame of best fit; any common factor of the b_i gives the same rotation, this one the scale of a gradient.
  const double scale = std::cbrt(spread(rest).determinant());
  for (int i = 0; i < 8; ++i) element.frame[i] = element.rest[i] / scale;
  if (shear_viscosity_ > 0) element.viscosity = incompatible_stiffness(rest, viscous_moduli(shear_viscosity_));
  const double share = std::cbrt(hex_volume(rest) / rest_volume(tissue, tissue.cells[tissue.element_cell[e].index()]));
  stiffness_[e] = springs_.stiffness > 0 ? springs_.stiffness * share
                                         : springs_.shear_modulus / attractor_moduli(rest, 1).mean_shear();
  preload_[e] = springs_.preload * share * share;
}

std::unique_ptr<Law> ShapeMemory::after_change(const Tissue& tissue, const TissueChange&, std::span<const Vec3>) const {
  return std::make_unique<ShapeMemory>(tissue, springs_, shear_viscosity_);
}

// E = sum k |u_i|^2 / 2 + P (s_i - e). The attractor's centre is the nodes' mean, so a node that moves takes an eighth
// of that from all: q_i is the tension of its spring less the mean of all eight.
double ShapeMemory::respond(std::size_t element, const Vec24& u, Vec24& q) const {
  const double k = stiffness_[element], P = preload_[element], e = springs_.preload_length;
  double energy = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = u.segment<3>(3 * i);
    const double s = std::sqrt(d.squaredNorm() + e * e);
    energy += 0.5 * k * d.squaredNorm() + P * d.squaredNorm() / (s + e);  // s - e without cancellation
    q.segment<3>(3 * i) = (k + P / s) * d;
  }
  q = without_mean(q);
  return energy;
}

const Mat24& ShapeMemory::local_stiffness(std::size_t element, const Vec24& u, Mat24& space) const {
  const double k = stiffness_[element], P = preload_[element], e = springs_.preload_length;
  std::array<Mat3, 8> own;  // of each spring
  Mat3 mean = Mat3::Zero();
  for (int i = 0; i < 8; ++i) {
    const Vec3 d = u.segment<3>(3 * i);
    const double s = std::sqrt(d.squaredNorm() + e * e);
    own[i] = (k + P / s) * Mat3::Identity() - (P / (s * s * s)) * (d * d.transpose());
    mean += own[i] / 8;
  }
  // Subtract the means of rows and columns.
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      Mat3 block = (mean - own[i] - own[j]) / 8;
      if (i == j) block += own[i];
      space.block<3, 3>(3 * i, 3 * j) = block;
    }
  return space;
}

}  // namespace plica
