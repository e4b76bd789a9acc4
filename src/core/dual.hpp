// Numbers that carry their derivatives: a formula in them gives its value, its gradient and, if asked, its Hessian by N
// variables (automatic differentiation, forward). They work as scalars of Eigen's vectors.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace plica {

template <int N, bool with_hessian>
class Dual {
 public:
  using Gradient = Eigen::Matrix<double, N, 1>;
  using Hessian = Eigen::Matrix<double, with_hessian ? N : 0, with_hessian ? N : 0>;

  Dual() : Dual(0) {}
  Dual(double constant) : value(constant), gradient(Gradient::Zero()), hessian(Hessian::Zero()) {}  // NOLINT: converts
  static Dual variable(double at, int number) {
    Dual result(at);
    result.gradient[number] = 1;
    return result;
  }

  double value;
  Gradient gradient;
  Hessian hessian;

  /// Return f(this), by f and its first and second derivative at the value.
  [[nodiscard]] Dual of(double f, double first, double second) const {
    Dual result(f);
    result.gradient = first * gradient;
    if constexpr (with_hessian) result.hessian = first * hessian + second * gradient * gradient.transpose();
    return result;
  }

  Dual& operator+=(const Dual& b) {
    value += b.value, gradient += b.gradient, hessian += b.hessian;
    return *this;
  }
  Dual& operator-=(const Dual& b) {
    value -= b.value, gradient -= b.gradient, hessian -= b.hessian;
    return *this;
  }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }
  Dual operator-() const { return of(-value, -1, 0); }

  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    Dual result(a.value * b.value);
    result.gradient = a.value * b.gradient + b.value * a.gradient;
    if constexpr (with_hessian) {
      const Hessian mixed = a.gradient * b.gradient.transpose();
      result.hessian = a.value * b.hessian + b.value * a.hessian + mixed + mixed.transpose();
    }
    return result;
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double inverse = 1 / b.value;
    return a * b.of(inverse, -inverse * inverse, 2 * inverse * inverse * inverse);
  }
  friend auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }

  friend Dual sqrt(const Dual& a) {
    const double root = std::sqrt(a.value);
    return a.of(root, 0.5 / root, -0.25 / (root * a.value));
  }
  friend Dual exp(const Dual& a) {
    const double e = std::exp(a.value);
    return a.of(e, e, e);
  }
  friend Dual log(const Dual& a) { return a.of(std::log(a.value), 1 / a.value, -1 / (a.value * a.value)); }
  friend Dual sin(const Dual& a) { return a.of(std::sin(a.value), std::cos(a.value), -std::sin(a.value)); }
  friend Dual cos(const Dual& a) { return a.of(std::cos(a.value), -std::sin(a.value), -std::cos(a.value)); }
  friend Dual pow(const Dual& a, double p) {
    return a.of(std::pow(a.value, p), p * std::pow(a.value, p - 1), p * (p - 1) * std::pow(a.value, p - 2));
  }
  friend Dual abs(const Dual& a) { return a.value < 0 ? -a : a; }
  // What Eigen asks of a real scalar.
  friend Dual abs2(const Dual& a) { return a * a; }
  friend const Dual& conj(const Dual& a) { return a; }
  friend const Dual& real(const Dual& a) { return a; }
};

}  // namespace plica

template <int N, bool with_hessian>
struct Eigen::NumTraits<plica::Dual<N, with_hessian>> : Eigen::GenericNumTraits<plica::Dual<N, with_hessian>> {
  enum { RequireInitialization = 1, ReadCost = N, AddCost = N, MulCost = 3 * N };
};
template <int N, bool with_hessian, class Operation>
struct Eigen::ScalarBinaryOpTraits<plica::Dual<N, with_hessian>, double, Operation> {
  using ReturnType = plica::Dual<N, with_hessian>;
};
template <int N, bool with_hessian, class Operation>
struct Eigen::ScalarBinaryOpTraits<double, plica::Dual<N, with_hessian>, Operation> {
  using ReturnType = plica::Dual<N, with_hessian>;
};
