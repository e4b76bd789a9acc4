#include "tissue/shapes/solid_harmonics.hpp"

#include <cmath>

namespace plica {
namespace {

constexpr int place(int l, int m) { return l * l + l + m; }

}  // namespace

void evaluate_harmonics(const Vec3& direction, int degree, HarmonicValues& values) {
  const double x = direction.x(), y = direction.y(), z = direction.z();
  double real = 1, imaginary = 0;  // R_mm
  for (int m = 0; m <= degree; ++m) {
    if (m > 0) {
      const double next = (x * real - y * imaginary) / (2 * m);
      imaginary = (x * imaginary + y * real) / (2 * m);
      real = next;
    }
    // (l^2 - m^2) R_lm = (2l - 1) z R_(l-1)m - R_(l-2)m on the unit sphere.
    double before[2] = {0, 0}, last[2] = {real, imaginary};
    for (int l = m; l <= degree; ++l) {
      if (l > m) {
        const double scale = 1.0 / (l * l - m * m);
        for (int part = 0; part < 2; ++part) {
          const double next = scale * ((2 * l - 1) * z * last[part] - before[part]);
          before[part] = last[part];
          last[part] = next;
        }
      }
      values[place(l, -m)] = last[1];
      values[place(l, m)] = last[0];
    }
  }
}

std::vector<double> harmonic_norms(int degree) {
  std::vector<double> norms(harmonic_count(degree));
  for (int l = 0; l <= degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const double product = std::exp(std::lgamma(l + m + 1) + std::lgamma(l - m + 1));
      norms[place(l, m)] = norms[place(l, -m)] = std::sqrt((2 * l + 1) * product * (m > 0 ? 2 : 1));
    }
  return norms;
}

std::vector<double> harmonic_derivative(const std::vector<double>& coefficients, int degree, int axis) {
  std::vector<double> derivative(coefficients.size(), 0.0);
  // Adds `factor` times Re or Im R_(l-1)m; places outside of the triangle |m| <= l - 1 are 0, and so is Im R_l0.
  const auto add = [&](int l, int m, bool real, double factor) {
    if (m > l - 1 || (m == 0 && !real)) return;
    derivative[place(l - 1, real ? m : -m)] += factor;
  };
  for (int l = 1; l <= degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const double real = coefficients[place(l, m)], imaginary = m > 0 ? coefficients[place(l, -m)] : 0;
      if (axis == 2) {
        add(l, m, true, real);
        add(l, m, false, imaginary);
      } else if (m == 0) {
        add(l, 1, axis == 0, -real);
      } else if (axis == 0) {
        add(l, m - 1, true, real / 2);
        add(l, m + 1, true, -real / 2);
        add(l, m - 1, false, imaginary / 2);
        add(l, m + 1, false, -imaginary / 2);
      } else {
        add(l, m - 1, false, -real / 2);
        add(l, m + 1, false, -real / 2);
        add(l, m - 1, true, imaginary / 2);
        add(l, m + 1, true, imaginary / 2);
      }
    }
  return derivative;
}

}  // namespace plica
