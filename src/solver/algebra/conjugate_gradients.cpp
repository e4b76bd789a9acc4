#include "solver/algebra/conjugate_gradients.hpp"

#include <cmath>

namespace plica {

ConjugateGradientsReport conjugate_gradients(const std::function<void(const Vectors&, Vectors&)>& multiply,
                                             const std::function<void(const Vectors&, Vectors&)>& precondition,
                                             const Vectors& b, double tolerance, int most_iterations,
                                             const std::function<bool()>& stop_requested, Vectors& x) {
  ConjugateGradientsReport report;
  x.assign(b.size(), Vec3::Zero());
  const double size = std::sqrt(dot(b, b));
  Vectors r = b, z(b.size()), Ap(b.size());
  precondition(r, z);
  Vectors p = z;
  double rz = dot(r, z);
  report.residual = size == 0 ? 0 : 1;  // 1 also where b is not finite: the first iteration shows it
  while (report.residual > tolerance && report.iterations < most_iterations) {
    if (stop_requested && stop_requested()) {
      report.interrupted = true;
      return report;
    }
    multiply(p, Ap);
    const double alpha = rz / dot(p, Ap);
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n] += alpha * p[n];
      r[n] -= alpha * Ap[n];
    }
    precondition(r, z);
    const double beta = dot(r, z) / rz;
    rz *= beta;
    for (std::size_t n = 0; n < x.size(); ++n) p[n] = z[n] + beta * p[n];
    ++report.iterations;
    report.residual = std::sqrt(dot(r, r)) / size;
  }
  report.converged = report.residual <= tolerance;
  return report;
}

}  // namespace plica
