#include "mechanics/coulomb.hpp"

namespace plica {
namespace {

// f'(v) / v
double secant(double v) {
  constexpr double s = Coulomb::stick_speed;
  return v < s ? (2 - v / s) / s : 1 / v;
}

}  // namespace

double Coulomb::potential(const Vec3& velocity) const {
  const double v = velocity.norm(), part = v / stick_speed;
  return limit * (part < 1 ? v * part * (1 - part / 3) : v - stick_speed / 3);
}

Vec3 Coulomb::force(const Vec3& velocity) const { return -limit * secant(velocity.norm()) * velocity; }

Mat3 Coulomb::resistance(const Vec3& velocity) const {
  const double v = velocity.norm();
  if (v == 0) return limit * secant(0) * Mat3::Identity();
  const Mat3 along = velocity * velocity.transpose() / (v * v);
  const double slope = v < stick_speed ? 2 / stick_speed * (1 - v / stick_speed) : 0;  // f''
  return limit * (secant(v) * (Mat3::Identity() - along) + slope * along);
}

}  // namespace plica
