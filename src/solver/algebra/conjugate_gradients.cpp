#include "solver/algebra/conjugate_gradients.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace plica {

KrylovReport conjugate_gradients(const KrylovOperator& multiply, const KrylovOperator& precondition,
                                 const KrylovVector& b, const KrylovRule& rule, const KrylovGoOn& go_on,
                                 KrylovVector& x) {
  KrylovReport report;
  x.assign(b.size(), 0.0);
  const double size = std::sqrt(parallel_dot(b, b));
  KrylovVector r = b, z(b.size()), Ap(b.size());
  precondition(r, z);
  KrylovVector p = z;
  double rz = parallel_dot(r, z);
  report.residual = size == 0 ? 0 : 1;  // 1 also where b is not finite: the first iteration shows it
  while (report.residual > rule.tolerance && report.iterations < rule.most_iterations) {
    if (go_on && !go_on(report)) {
      report.interrupted = true;
      return report;
    }
    multiply(p, Ap);
    const double alpha = rz / parallel_dot(p, Ap);
    for (std::size_t n = 0; n < x.size(); ++n) {
      x[n] += alpha * p[n];
      r[n] -= alpha * Ap[n];
    }
    precondition(r, z);
    const double beta = parallel_dot(r, z) / rz;
    rz *= beta;
    for (std::size_t n = 0; n < x.size(); ++n) p[n] = z[n] + beta * p[n];
    ++report.iterations;
    report.residual = std::sqrt(parallel_dot(r, r)) / size;
  }
  report.converged = report.residual <= rule.tolerance;
  return report;
}

}  // namespace plica
