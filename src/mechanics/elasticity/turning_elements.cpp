// Letters as in docs/theory/corotational.md: F = sum_i x_i b_i^T, R its rotation, S = R^T F its stretch, u local
// displacement, y = R^T (x - c) local position, q = dE/du local force without the turning of R, t = H (sum y_i x q_i)
// with H = (tr(S) I - S)^-1, g_i = q_i - t x b_i the gradient in the local frame.
#include "mechanics/elasticity/turning_elements.hpp"

#include <stdexcept>

#include "core/parallel.hpp"
#include "mechanics/energy.hpp"

namespace plica {
namespace {

using Mat24x3 = Eigen::Matrix<double, 24, 3>;
using Mat3x24 = Eigen::Matrix<double, 3, 24>;

}  // namespace

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

void require_upright_rest_shapes(const Tissue& tissue) {
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (hex_scaled_jacobian(tissue.element_rest_shape[e]) <= 0)
      throw std::domain_error("element " + std::to_string(e) + " of cell " +
                              std::to_string(tissue.element_cell[e].number()) + " is inverted or flat at rest");
}

TurningElements::TurningElements(const Tissue& tissue, bool viscous)
    : elements_(tissue.elements.size()), chunks_(tissue, tissue.elements), viscous_(viscous) {
  require_upright_rest_shapes(tissue);
  for (std::size_t e = 0; e < elements_.size(); ++e) elements_[e].nodes = tissue.elements[e];
}

void TurningElements::take_rest_shape(const Tissue& tissue, std::size_t e) {
  const HexPoints& rest = tissue.element_rest_shape[e];
  Vec3 centre = Vec3::Zero();
  for (const Vec3& point : rest) centre += point / 8;
  for (int i = 0; i < 8; ++i) elements_[e].rest[i] = rest[i] - centre;
}

struct TurningElements::Frame {
  Mat3 R, S, H;
  Vec24 u;  // local displacement
  Vec24 q;  // dE/du, and the viscous part
  Vec24 g;  // gradient of the energy in the local frame
  std::array<Vec3, 8> y;
  Vec3 t;
  double energy = 0;
  double viscous_factor = 0;  // 1/rate_s
};

TurningElements::Frame TurningElements::frame(std::size_t e, const Step& step) const {
  const Element& element = elements_[e];
  // The local displacement at given positions, with its rotation and stretch.
  const auto localise = [&](std::span<const Vec3> positions, Mat3& R, Mat3& S, std::array<Vec3, 8>& y) {
    Mat3 F = Mat3::Zero();
    Vec3 centre = Vec3::Zero();
    for (int i = 0; i < 8; ++i) centre += positions[element.nodes[i].index()] / 8;
    for (int i = 0; i < 8; ++i) F += (positions[element.nodes[i].index()] - centre) * element.frame[i].transpose();
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
  f.energy = respond(e, f.u, f.q);
  if (viscous_) {
    const Vec24 change = f.u - step.before([&](std::span<const Vec3> positions) -> Vec24 {
      Mat3 rotation, stretch;
      std::array<Vec3, 8> y;
      return localise(positions, rotation, stretch, y);
    });
    f.viscous_factor = 1 / step.rate_s;
    const Vec24 viscous = f.viscous_factor * (element.viscosity * change);
    f.energy += 0.5 * change.dot(viscous);
    f.q += viscous;
  }
  // The rotation of R with x adds -t x b_i. H exists unless the stretch is far from 1 (two principal stretches sum to
  // 0).
  f.H = (f.S.trace() * Mat3::Identity() - f.S).inverse();
  Vec3 torque = Vec3::Zero();
  for (int i = 0; i < 8; ++i) torque += f.y[i].cross(Vec3(f.q.segment<3>(3 * i)));
  f.t = f.H * torque;
  for (int i = 0; i < 8; ++i) f.g.segment<3>(3 * i) = f.q.segment<3>(3 * i) - f.t.cross(element.frame[i]);
  return f;
}

double TurningElements::energy(const Step& step) const {
  return chunks_.sum_over_elements([&](std::size_t e) { return frame(e, step).energy; });
}

EnergyFlow TurningElements::energy_flow(const CompletedStep& completed) const {
  return viscous_ ? viscous_energy_flow(*this, completed) : Law::energy_flow(completed);
}

void TurningElements::add_forces(const Step& step, std::span<Vec3> forces) const {
  chunks_.for_elements([&](std::size_t e) {
    const Frame f = frame(e, step);
    for (int i = 0; i < 8; ++i) forces[elements_[e].nodes[i].index()] -= f.R * f.g.segment<3>(3 * i);
  });
}

// R K R^T times a vector: the tangent without the turning of R.
void TurningElements::add_warped_product(const Step& step, std::span<const Vec3> direction,
                                         std::span<Vec3> product) const {
  chunks_.for_elements([&](std::size_t e) {
    const Element& element = elements_[e];
    const Frame f = frame(e, step);
    Vec24 w;
    for (int i = 0; i < 8; ++i) w.segment<3>(3 * i) = f.R.transpose() * direction[element.nodes[i].index()];
    Mat24 space;
    Vec24 q = local_stiffness(e, f.u, space) * w;
    if (viscous_) q += f.viscous_factor * (element.viscosity * w);
    for (int i = 0; i < 8; ++i) product[element.nodes[i].index()] += f.R * q.segment<3>(3 * i);
  });
}

void TurningElements::add_tangent_product(const Step& step, std::span<const Vec3> direction,
                                          std::span<Vec3> product) const {
  if (step.semidefinite_tangent) return add_warped_product(step, direction, product);
  chunks_.for_elements([&](std::size_t e) {
    const Element& element = elements_[e];
    const Frame f = frame(e, step);
    const auto& b = element.frame;
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
    Mat24 space;
    Vec24 dq = local_stiffness(e, f.u, space) * du;
    if (viscous_) dq += f.viscous_factor * (element.viscosity * du);
    // dS and from it dt; then d(R g_i) = R (omega x g_i + dq_i - dt x b_i).
    const Mat3 dS = stretching - cross_matrix(omega) * f.S;
    Vec3 dtorque = dS * f.t - dS.trace() * f.t;
    for (int i = 0; i < 8; ++i)
      dtorque +=
          Vec3(du.segment<3>(3 * i)).cross(Vec3(f.q.segment<3>(3 * i))) + f.y[i].cross(Vec3(dq.segment<3>(3 * i)));
    const Vec3 dt = f.H * dtorque;
    for (int i = 0; i < 8; ++i)
      product[element.nodes[i].index()] +=
          f.R * (omega.cross(Vec3(f.g.segment<3>(3 * i))) + Vec3(dq.segment<3>(3 * i)) - dt.cross(b[i]));
  });
}

void TurningElements::add_tangent(const Step& step, TangentSink& tangent) const {
  const auto add = [&](const Element& element, const Mat3& R, const Mat24& K) {
    for (int i = 0; i < 8; ++i)
      for (int j = 0; j <= i; ++j)
        tangent.add_block(element.nodes[i], element.nodes[j], R * K.block<3, 3>(3 * i, 3 * j) * R.transpose());
  };
  chunks_.for_elements(
      [&](std::size_t e) {
        const Element& element = elements_[e];
        const Frame f = frame(e, step);
        Mat24 space;
        Mat24 K = local_stiffness(e, f.u, space);
        if (viscous_) K += f.viscous_factor * element.viscosity;
        if (step.semidefinite_tangent) {
          add(element, f.R, K);
          return;
        }
        // The product above as matrices: omega = G w, du = (I + Y G) w with Y_i = [y_i]x.
        Mat3x24 G, Q, D;
        Mat24x3 Y, g;
        for (int i = 0; i < 8; ++i) {
          const Vec3& b = element.frame[i];
          G.middleCols<3>(3 * i) = f.H * cross_matrix(b);
          Q.middleCols<3>(3 * i) = -cross_matrix(f.q.segment<3>(3 * i));
          D.middleCols<3>(3 * i) = b.dot(f.t) * Mat3::Identity() - f.t * b.transpose();
          Y.middleRows<3>(3 * i) = cross_matrix(f.y[i]);
          g.middleRows<3>(3 * i) = cross_matrix(f.g.segment<3>(3 * i));
        }
        // lazyProduct: these products are too small for Eigen's blocked kernels.
        const Mat24x3 W = K.lazyProduct(Y);
        const Mat3 middle = Y.transpose().lazyProduct(W) - Q.lazyProduct(Y) - cross_matrix(f.S * f.t);
        const Mat24x3 left = W - g;
        const Mat3x24 right = W.transpose() - Q - D + middle.lazyProduct(G);
        K += left.lazyProduct(G);
        K += G.transpose().lazyProduct(right);
        add(element, f.R, 0.5 * (K + K.transpose()));  // removes rounding asymmetry
      },
      tangent.accepts_concurrent_blocks());
}

NodeGroups TurningElements::node_groups(std::span<const double> /*internal*/) const {
  NodeGroups groups;
  for (const Element& element : elements_) groups.add(element.nodes);
  return groups;
}

}  // namespace plica
