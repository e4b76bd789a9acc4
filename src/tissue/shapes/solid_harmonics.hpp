// Real solid harmonics: polynomials in x, y, z that form, on the unit sphere, an orthogonal basis of all polynomials up
// to a degree. Their derivatives are again solid harmonics, so a sum of them is differentiated by its coefficients.
//
// With R_lm = r^l P_lm(cos theta) exp(i m phi) / (l + m)!, place l^2 + l + m holds Re R_lm for m >= 0, Im R_l|m| for
// m < 0. (Monomials span the same space, but a fit by them loses digits with every degree.)
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"

namespace plica {

inline constexpr int largest_harmonic_degree = 16;

/// Return the number of harmonics up to the degree.
constexpr std::size_t harmonic_count(int degree) {
  return static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 1);
}

using HarmonicValues = std::array<double, harmonic_count(largest_harmonic_degree)>;

/// Evaluate the harmonics up to `degree` at a unit vector; later places are not set.
void evaluate_harmonics(const Vec3& direction, int degree, HarmonicValues& values);

/// Return factors that give each harmonic a mean square of 1 over the sphere.
std::vector<double> harmonic_norms(int degree);

/// Return the coefficients of the derivative along x, y or z (axis 0, 1, 2); the number is unchanged, the highest
/// degree is 0.
std::vector<double> harmonic_derivative(const std::vector<double>& coefficients, int degree, int axis);

}  // namespace plica
