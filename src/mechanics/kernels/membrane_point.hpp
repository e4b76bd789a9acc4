// Incompressible neo-Hookean membrane at a Gauss point of a face, with Maxwell relaxation (docs/theory/matrix.md).
//
// With the metric C at the end of a step of r relaxation times, the rest metric B at its beginning, I_1 = tr(B^-1 C)
// and I_2 = det C/det B, the energy is weight/2 Phi(I_1, I_2), where
//   Phi = 3/r (D^(1/3) - 1) - 3,  D = (1 + r I_1 + r^2 I_2)(1 + r/I_2);  I_1 + 1/I_2 - 3 for r = 0.
// D^(1/3) is the determinant by which the step ends at the rest metric (B + r C)/D^(1/3).
#pragma once

#include <Eigen/Dense>
#include <utility>

namespace plica {

class MembranePoint {
 public:
  using Mat2 = Eigen::Matrix2d;  // in the coordinates of the face

  /// `weight`: shear modulus times thickness times unstretched area, nN um.
  MembranePoint(const Mat2& before, const Mat2& metric, double weight, double r);

  [[nodiscard]] double energy() const;
  /// Return 2 d(energy)/dC.
  [[nodiscard]] Mat2 stress() const;
  /// Return the change of the stress by a change of C.
  [[nodiscard]] Mat2 stress_change(const Mat2& of_metric) const;
  /// Return the gradient of stress : E by B.
  [[nodiscard]] Mat2 stress_gradient(const Mat2& E) const;

  /// Return the rest metric at the end of the step.
  [[nodiscard]] Mat2 rest() const;
  /// Return the point with this rest metric and no relaxation: it has the same stress.
  [[nodiscard]] MembranePoint relaxed() const { return {rest(), C_, weight_, 0}; }
  /// Return the gradients of Q : rest by B and by C.
  [[nodiscard]] std::pair<Mat2, Mat2> rest_gradients(const Mat2& Q) const;

 private:
  Mat2 B_, C_, inverse_B_, inverse_C_;
  double weight_, r_, I1_, I2_, D_, root_;  // root: D^(1/3)
  double of_1_, of_2_;                      // derivatives of D by I_1 and I_2, over r
  double d1_, d2_, d11_, d12_, d22_;        // derivatives of Phi
};

}  // namespace plica
