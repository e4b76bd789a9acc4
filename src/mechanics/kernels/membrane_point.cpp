#include "mechanics/kernels/membrane_point.hpp"

#include <cmath>

namespace plica {

MembranePoint::MembranePoint(const Mat2& before, const Mat2& metric, double weight, double r)
    : B_(before), C_(metric), inverse_B_(before.inverse()), inverse_C_(metric.inverse()), weight_(weight), r_(r) {
  I1_ = inverse_B_.cwiseProduct(C_).sum();
  I2_ = C_.determinant() / B_.determinant();
  const double thinned = 1 + r / I2_, square = I2_ * I2_;
  D_ = (1 + r * (I1_ + r * I2_)) * thinned;
  root_ = std::cbrt(D_);
  of_1_ = thinned;
  of_2_ = r - (1 + r * I1_) / square;
  // dPhi = D^(-2/3) dD/r.
  const double f = root_ / D_, bend = 2.0 / 3 * f / D_ * r;
  d1_ = f * of_1_;
  d2_ = f * of_2_;
  d11_ = -bend * of_1_ * of_1_;
  d12_ = -f * r / square - bend * of_1_ * of_2_;
  d22_ = 2 * f * (1 + r * I1_) / (square * I2_) - bend * of_2_ * of_2_;
}

double MembranePoint::energy() const {
  const double excess = I1_ + r_ * I2_ + (1 + r_ * (I1_ + r_ * I2_)) / I2_;  // (D - 1)/r
  const double stretched = r_ > 0 ? 3 * std::expm1(std::log1p(r_ * excess) / 3) / r_ : excess;
  return 0.5 * weight_ * (stretched - 3);
}

MembranePoint::Mat2 MembranePoint::stress() const { return weight_ * (d1_ * inverse_B_ + d2_ * I2_ * inverse_C_); }

MembranePoint::Mat2 MembranePoint::stress_change(const Mat2& dC) const {
  const double dI1 = inverse_B_.cwiseProduct(dC).sum(), dI2 = I2_ * inverse_C_.cwiseProduct(dC).sum();
  const double of_rest = d11_ * dI1 + d12_ * dI2, of_metric = d12_ * I2_ * dI1 + (d22_ * I2_ + d2_) * dI2;
  return weight_ * (of_rest * inverse_B_ + of_metric * inverse_C_ - d2_ * I2_ * inverse_C_ * dC * inverse_C_);
}

MembranePoint::Mat2 MembranePoint::stress_gradient(const Mat2& E) const {
  const double x = inverse_B_.cwiseProduct(E).sum(), y = inverse_C_.cwiseProduct(E).sum();
  const double of_I1 = d11_ * x + d12_ * I2_ * y, of_I2 = d12_ * x + (d22_ * I2_ + d2_) * y;
  return -weight_ *
         (of_I1 * inverse_B_ * C_ * inverse_B_ + of_I2 * I2_ * inverse_B_ + d1_ * inverse_B_ * E * inverse_B_);
}

MembranePoint::Mat2 MembranePoint::rest() const { return (B_ + r_ * C_) / root_; }

std::pair<MembranePoint::Mat2, MembranePoint::Mat2> MembranePoint::rest_gradients(const Mat2& Q) const {
  const double of_D = -Q.cwiseProduct(B_ + r_ * C_).sum() / (3 * root_ * D_) * r_;
  const Mat2 of_before = Q / root_ - of_D * (of_1_ * inverse_B_ * C_ * inverse_B_ + of_2_ * I2_ * inverse_B_);
  const Mat2 of_metric = r_ / root_ * Q + of_D * (of_1_ * inverse_B_ + of_2_ * I2_ * inverse_C_);
  return {of_before, of_metric};
}

}  // namespace plica
