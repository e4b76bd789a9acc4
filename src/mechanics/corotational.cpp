// Letters as in docs/theory/corotational.md: F mean deformation gradient, R its rotation, S = R^T F its stretch, u
// local displacement, y = R^T (x - c) local position, q = K u local force without the turning of R, t = H (sum y_i x
// q_i) with H = (tr(S) I - S)^-1, g_i = q_i - t x b_i the gradient in the local frame.
#include "mechanics/corotational.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/parallel.hpp"

namespace plica {
namespace {

using Mat24x3 = Eigen::Matrix<double, 24, 3>;
using Mat3x24 = Eigen::Matrix<double, 3, 24>;
using Mat6x24 = Eigen::Matrix<double, 6, 24>;
using Mat6x9 = Eigen::Matrix<double, 6, 9>;
using Mat6 = Eigen::Matrix<double, 6, 6>;

const std::array<Vec3, 8>& gauss_points() {
  static const std::array<Vec3, 8> points = [] {
    std::array<Vec3, 8> p;
    for (int i = 0; i < 8; ++i) p[i] = hex_reference_nodes[i] / std::sqrt(3.0);
    return p;
  }();
  return points;
}

// Columns of the strain-displacement matrix for a shape function with gradient g. Strain order: xx yy zz xy yz zx, with
// engineering shears.
Eigen::Matrix<double, 6, 3> strain_columns(const Vec3& g) {
  Eigen::Matrix<double, 6, 3> b = Eigen::Matrix<double, 6, 3>::Zero();
  b(0, 0) = g.x(), b(1, 1) = g.y(), b(2, 2) = g.z();
  b(3, 0) = g.y(), b(3, 1) = g.x();
  b(4, 1) = g.z(), b(4, 2) = g.y();
  b(5, 0) = g.z(), b(5, 2) = g.x();
  return b;
}

Mat6 stress_matrix(const ElasticModuli& moduli) {
  Mat6 d = Mat6::Zero();
  d.topLeftCorner<3, 3>().setConstant(moduli.lame_lambda);
  for (int i = 0; i < 3; ++i) d(i, i) += 2 * moduli.shear_modulus;
  for (int i = 3; i < 6; ++i) d(i, i) = moduli.shear_modulus;
  return d;
}

// The nearest rotation R to F and the stretch S = R^T F. Newton's iteration for the polar factor, X <- (X + X^-T)/2
// (Higham 1986), converges quadratically wherever det F > 0; elsewhere, on the way to being rejected, the SVD serves.
void polar(const Mat3& F, Mat3& R, Mat3& S) {
  R = F;
  for (int iteration = 0; iteration < 20; ++iteration) {
    // X^-T is the matrix of cofactors over the determinant.
    Mat3 cofactors;
    cofactors.col(0) = R.col(1).cross(R.col(2));
    cofactors.col(1) = R.col(2).cross(R.col(0));
    cofactors.col(2) = R.col(0).cross(R.col(1));
    const double determinant = R.col(0).dot(cofactors.col(0));
    if (!(determinant > 1e-3)) break;
    const Mat3 next = 0.5 * (R + cofactors / determinant);
    const double change = (next - R).squaredNorm();
    R = next;
    // Quadratic: the next change would be below rounding.
    if (change < 1e-18) {
      S = R.transpose() * F;
      S = 0.5 * (S + S.transpose()).eval();
      return;
    }
  }
  const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 sign = Vec3::Ones();
  if ((svd.matrixU() * svd.matrixV().transpose()).determinant() < 0) sign.z() = -1;
  R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  S = svd.matrixV() * (sign.cwiseProduct(svd.singularValues())).asDiagonal() * svd.matrixV().transpose();
}

}  // namespace

ElasticModuli ElasticModuli::from_young(double young_modulus, double poisson_ratio) {
  return {young_modulus * poisson_ratio / ((1 + poisson_ratio) * (1 - 2 * poisson_ratio)),
          young_modulus / (2 * (1 + poisson_ratio))};
}

std::array<Vec3, 8> mean_gradients(const HexPoints& rest) {
  std::array<Vec3, 8> gradients = hex_volume_gradient(rest);
  const double volume = hex_volume(rest);
  for (Vec3& gradient : gradients) gradient /= volume;
  return gradients;
}

Mat24 incompatible_stiffness(const HexPoints& rest, const ElasticModuli& moduli) {
  const Mat6 d = stress_matrix(moduli);
  const Mat3 centre_jacobian = hex_jacobian(rest, Vec3::Zero());
  const Mat3 centre_inverse = centre_jacobian.inverse();
  const double centre_determinant = centre_jacobian.determinant();

  Mat24 compatible = Mat24::Zero();
  Eigen::Matrix<double, 9, 24> mixed = Eigen::Matrix<double, 9, 24>::Zero();
  Eigen::Matrix<double, 9, 9> modes = Eigen::Matrix<double, 9, 9>::Zero();
  for (const Vec3& point : gauss_points()) {
    const Mat3 jacobian = hex_jacobian(rest, point);
    const Mat3 inverse = jacobian.inverse();
    const double weight = jacobian.determinant();
    const std::array<Vec3, 8> gradients = hex_shape_gradients(point);
    Mat6x24 b;
    for (int i = 0; i < 8; ++i) b.middleCols<3>(3 * i) = strain_columns(inverse.transpose() * gradients[i]);
    // Modes 1 - xi^2 and so on, their gradients taken with the centre's Jacobian so that they vanish in the mean.
    Mat6x9 m;
    for (int k = 0; k < 3; ++k) {
      const Vec3 local = -2 * point[k] * Vec3::Unit(k);
      m.middleCols<3>(3 * k) = strain_columns((centre_determinant / weight) * (centre_inverse.transpose() * local));
    }
    compatible += weight * b.transpose() * d * b;
    mixed += weight * m.transpose() * d * b;
    modes += weight * m.transpose() * d * m;
  }
  Mat24 stiffness = compatible - mixed.transpose() * modes.ldlt().solve(mixed);
  return 0.5 * (stiffness + stiffness.transpose());
}

Corotational::Corotational(const Tissue& tissue, const ElasticModuli& moduli, double shear_viscosity)
    : elements_(tissue.elements.size()), viscous_(shear_viscosity > 0) {
  const ElasticModuli viscous_moduli{-2 * shear_viscosity / 3, shear_viscosity};  // deviatoric
  std::vector<char> inverted(elements_.size(), 0);
  parallel_for(elements_.size(), [&](std::size_t e) {
    const HexPoints& rest = tissue.element_rest_shape[e];
    Element& element = elements_[e];
    element.nodes = tissue.elements[e];
    if (hex_scaled_jacobian(rest) <= 0) {
      inverted[e] = 1;
      return;
    }
    element.mean_gradient = mean_gradients(rest);
    Vec3 centre = Vec3::Zero();
    for (const Vec3& point : rest) centre += point / 8;
    for (int i = 0; i < 8; ++i) element.rest[i] = rest[i] - centre;
    Vec24 b;
    for (int i = 0; i < 8; ++i) b.segment<3>(3 * i) = element.mean_gradient[i];
    element.stiffness =
        incompatible_stiffness(rest, moduli) - moduli.bulk_modulus() * hex_volume(rest) * b * b.transpose();
    if (viscous_) element.viscosity = incompatible_stiffness(rest, viscous_moduli);
  });
  const auto bad = std::find(inverted.begin(), inverted.end(), 1);
  if (bad != inverted.end()) {
    const auto e = static_cast<std::size_t>(bad - inverted.begin());
    throw std::domain_error("element " + std::to_string(e) + " of cell " +
                            std::to_string(tissue.element_cell[e].number()) + " is inverted or flat at rest");
  }
}

struct Corotational::Frame {
  Mat3 R, S, H;
  Vec24 u;  // local displacement
  Vec24 q;  // K u, and the viscous part
  Vec24 g;  // gradient of the energy in the local frame
  std::array<Vec3, 8> y;
  Vec3 t;
  double energy = 0;
  double viscous_factor = 0;  // 1/h
};

Corotational::Frame Corotational::frame(const Element& element, const Step& step) const {
  // The local displacement at given positions, with its rotation and stretch.
  const auto localise = [&](std::span<const Vec3> positions, Mat3& R, Mat3& S, std::array<Vec3, 8>& y) {
    Mat3 F = Mat3::Zero();
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < 8; ++i) centre += positions[element.nodes[i].index()] / 8;
    for (int i = 0; i < 8; ++i)
      F += (positions[element.nodes[i].index()] - centre) * element.mean_gradient[i].transpose();
    polar(F, R, S);
    Vec24 u;
    for (int i = 0; i < 8; ++i) {
      y[i] = R.transpose() * (positions[element.nodes[i].index()] - centre);
      u.segment<3>(3 * i) = y[i] - element.rest[i];
    }
    return u;
  };

  Frame f;
  f.u = localise(step.positions, f.R, f.S, f.y);
  f.q.noalias() = element.stiffness * f.u;
  f.energy = 0.5 * f.u.dot(f.q);
  if (viscous_) {
    Mat3 previous_rotation, previous_stretch;
    std::array<Vec3, 8> previous_y;
    const Vec24 change = f.u - localise(step.previous_positions, previous_rotation, previous_stretch, previous_y);
    f.viscous_factor = 1 / step.duration_s;
    const Vec24 viscous = f.viscous_factor * (element.viscosity * change);
    f.energy += 0.5 * change.dot(viscous);
    f.q += viscous;
  }
  // How R turns with x adds -t x b_i. H exists unless the stretch is far from 1 (two principal stretches sum to 0).
  f.H = (f.S.trace() * Mat3::Identity() - f.S).inverse();
  Vec3 torque = Vec3::Zero();
  for (int i = 0; i < 8; ++i) torque += f.y[i].cross(Vec3(f.q.segment<3>(3 * i)));
  f.t = f.H * torque;
  for (int i = 0; i < 8; ++i) f.g.segment<3>(3 * i) = f.q.segment<3>(3 * i) - f.t.cross(element.mean_gradient[i]);
  return f;
}

double Corotational::energy(const Step& step) const {
  std::vector<double> energies(elements_.size());
  parallel_for(elements_.size(), [&](std::size_t e) { energies[e] = frame(elements_[e], step).energy; });
  double sum = 0;
  for (const double energy : energies) sum += energy;
  return sum;
}

void Corotational::add_forces(const Step& step, std::span<Vec3> forces) const {
  std::vector<std::array<Vec3, 8>> gradients(elements_.size());
  parallel_for(elements_.size(), [&](std::size_t e) {
    const Frame f = frame(elements_[e], step);
    for (int i = 0; i < 8; ++i) gradients[e][i] = f.R * f.g.segment<3>(3 * i);
  });
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (int i = 0; i < 8; ++i) forces[elements_[e].nodes[i].index()] -= gradients[e][i];
}

// R K R^T times a vector; of a frame only the rotation is needed.
void Corotational::add_warped_product(const Step& step, std::span<const Vec3> direction,
                                      std::span<Vec3> product) const {
  std::vector<std::array<Vec3, 8>> results(elements_.size());
  parallel_for(elements_.size(), [&](std::size_t e) {
    const Element& element = elements_[e];
    Mat3 F = Mat3::Zero(), R, S;
    const Vec3& origin = step.positions[element.nodes[0].index()];  // any: the mean gradients add up to zero
    for (int i = 1; i < 8; ++i)
      F += (step.positions[element.nodes[i].index()] - origin) * element.mean_gradient[i].transpose();
    polar(F, R, S);
    Vec24 w;
    for (int i = 0; i < 8; ++i) w.segment<3>(3 * i) = R.transpose() * direction[element.nodes[i].index()];
    Vec24 q = element.stiffness * w;
    if (viscous_) q += 1 / step.duration_s * (element.viscosity * w);
    for (int i = 0; i < 8; ++i) results[e][i] = R * q.segment<3>(3 * i);
  });
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (int i = 0; i < 8; ++i) product[elements_[e].nodes[i].index()] += results[e][i];
}

void Corotational::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                       std::span<Vec3> product) const {
  if (step.semidefinite_tangent) return add_warped_product(step, direction, product);
  std::vector<std::array<Vec3, 8>> results(elements_.size());
  parallel_for(elements_.size(), [&](std::size_t e) {
    const Element& element = elements_[e];
    const Frame f = frame(element, step);
    const auto& b = element.mean_gradient;
    // w: the direction in the local frame; omega: how fast the frame turns; du: the change of u (and of y).
    std::array<Vec3, 8> w;
    Vec3 spin = Vec3::Zero();
    Mat3 stretching = Mat3::Zero();
    for (int i = 0; i < 8; ++i) {
      w[i] = f.R.transpose() * direction[element.nodes[i].index()];
      spin += b[i].cross(w[i]);
      stretching += w[i] * b[i].transpose();
    }
    const Vec3 omega = f.H * spin;
    Vec24 du;
    for (int i = 0; i < 8; ++i) du.segment<3>(3 * i) = w[i] - omega.cross(f.y[i]);
    Vec24 dq = element.stiffness * du;
    if (viscous_) dq += f.viscous_factor * (element.viscosity * du);
    // dS and from it dt; then d(R g_i) = R (omega x g_i + dq_i - dt x b_i).
    const Mat3 dS = stretching - cross_matrix(omega) * f.S;
    Vec3 dtorque = dS * f.t - dS.trace() * f.t;
    for (int i = 0; i < 8; ++i)
      dtorque +=
          Vec3(du.segment<3>(3 * i)).cross(Vec3(f.q.segment<3>(3 * i))) + f.y[i].cross(Vec3(dq.segment<3>(3 * i)));
    const Vec3 dt = f.H * dtorque;
    for (int i = 0; i < 8; ++i)
      results[e][i] = f.R * (omega.cross(Vec3(f.g.segment<3>(3 * i))) + Vec3(dq.segment<3>(3 * i)) - dt.cross(b[i]));
  });
  for (std::size_t e = 0; e < elements_.size(); ++e)
    for (int i = 0; i < 8; ++i) product[elements_[e].nodes[i].index()] += results[e][i];
}

void Corotational::add_tangent(const Step& step, TangentSink& tangent) const {
  // A batch at a time: computed by all threads, added in order.
  constexpr std::size_t batch = 1024;
  std::vector<Mat24> blocks(std::min(batch, elements_.size()));
  std::vector<Mat3> rotations(blocks.size());
  for (std::size_t first = 0; first < elements_.size(); first += batch) {
    const std::size_t count = std::min(batch, elements_.size() - first);
    parallel_for(count, [&](std::size_t k) {
      const Element& element = elements_[first + k];
      const Frame f = frame(element, step);
      if (step.semidefinite_tangent) {
        blocks[k] = element.stiffness;
        if (viscous_) blocks[k] += f.viscous_factor * element.viscosity;
        rotations[k] = f.R;
        return;
      }
      // The product above as matrices: omega = G w, du = (I + Y G) w with Y_i = [y_i]x.
      Mat3x24 G, Q, D;
      Mat24x3 Y, g;
      for (int i = 0; i < 8; ++i) {
        const Vec3& b = element.mean_gradient[i];
        G.middleCols<3>(3 * i) = f.H * cross_matrix(b);
        Q.middleCols<3>(3 * i) = -cross_matrix(f.q.segment<3>(3 * i));
        D.middleCols<3>(3 * i) = b.dot(f.t) * Mat3::Identity() - f.t * b.transpose();
        Y.middleRows<3>(3 * i) = cross_matrix(f.y[i]);
        g.middleRows<3>(3 * i) = cross_matrix(f.g.segment<3>(3 * i));
      }
      Mat24 K = element.stiffness;
      if (viscous_) K += f.viscous_factor * element.viscosity;
      // lazyProduct: these products are too small for Eigen's blocked kernels.
      const Mat24x3 W = K.lazyProduct(Y);
      const Mat3 middle = Y.transpose().lazyProduct(W) - Q.lazyProduct(Y) - cross_matrix(f.S * f.t);
      const Mat24x3 left = W - g;
      const Mat3x24 right = W.transpose() - Q - D + middle.lazyProduct(G);
      K += left.lazyProduct(G);
      K += G.transpose().lazyProduct(right);
      blocks[k] = 0.5 * (K + K.transpose());  // symmetric but for rounding
      rotations[k] = f.R;
    });
    for (std::size_t k = 0; k < count; ++k) {
      const auto& nodes = elements_[first + k].nodes;
      const Mat3& R = rotations[k];
      for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
          tangent.add_block(nodes[i], nodes[j], R * blocks[k].block<3, 3>(3 * i, 3 * j) * R.transpose());
    }
  }
}

NodeGroups Corotational::node_groups() const {
  NodeGroups groups;
  for (const Element& element : elements_) groups.emplace_back(element.nodes.begin(), element.nodes.end());
  return groups;
}

}  // namespace plica
