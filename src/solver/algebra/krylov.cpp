#include "solver/algebra/krylov.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace plica {
namespace {

void add(double factor, const KrylovVector& a, KrylovVector& to) {
  parallel_for(to.size(), [&](std::size_t i) { to[i] += factor * a[i]; });
}

}  // namespace

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

KrylovReport ConjugateResiduals::solve(const KrylovOperator& multiply, const KrylovOperator& precondition,
                                       const KrylovVector& b, const KrylovRule& rule, const KrylovGoOn& go_on,
                                       KrylovVector& x) {
  KrylovReport report;
  x.assign(b.size(), 0.0);
  residual_ = b;
  const double norm = std::sqrt(parallel_dot(b, b));
  report.residual = norm == 0 ? 0 : norm / norm;  // not a number stays one
  int kept = 0;
  while (true) {
    report.converged = report.residual <= rule.tolerance;
    if (report.converged || report.iterations >= rule.most_iterations || !std::isfinite(report.residual)) return report;
    if (go_on && !go_on(report)) {
      report.interrupted = true;
      return report;
    }
    if (kept == rule.most_kept) kept = 0;
    if (static_cast<int>(directions_.size()) == kept) {
      directions_.emplace_back();
      products_.emplace_back();
    }
    KrylovVector &p = directions_[kept], &q = products_[kept];
    p.resize(b.size());
    q.resize(b.size());
    precondition(residual_, p);
    multiply(p, q);
    for (int k = 0; k < kept; ++k) {
      const double along = parallel_dot(q, products_[k]);
      add(-along, products_[k], q);
      add(-along, directions_[k], p);
    }
    const double length = std::sqrt(parallel_dot(q, q));
    if (!(length > 0)) return report;  // nothing new: the preconditioner leads nowhere
    parallel_for(b.size(), [&](std::size_t i) {
      p[i] /= length;
      q[i] /= length;
    });
    const double step = parallel_dot(residual_, q);
    add(step, p, x);
    add(-step, q, residual_);
    report.residual = std::sqrt(parallel_dot(residual_, residual_)) / norm;
    ++kept;
    ++report.iterations;
  }
}

}  // namespace plica
