// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): a linear system known by its products only, of
// any kind of matrix; the residual is the least that the directions so far allow, as in GMRES.
#pragma once

#include <functional>
#include <vector>

namespace plica {

struct ConjugateResidualsReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|, as the recurrence has it
  bool converged = false;
  bool interrupted = false;
};

/// When to stop.
struct ConjugateResidualsRule {
  double tolerance = 1e-3;  // of |b - A x| / |b|
  int most_iterations = 200;
  int most_kept = 30;  // directions that are kept; then it begins anew
};

/// Solves A x = b from x = 0. `multiply(p, Ap)` sets Ap; `precondition(r, z)` sets z to an approximate A^-1 r, which
/// may be another from one iteration to the next; `go_on(report)` is asked before each. Sums are taken in a fixed
/// order: the same bits for any number of threads.
class ConjugateResiduals {
 public:
  using Vector = std::vector<double>;
  ConjugateResidualsReport solve(const std::function<void(const Vector&, Vector&)>& multiply,
                                 const std::function<void(const Vector&, Vector&)>& precondition, const Vector& b,
                                 const ConjugateResidualsRule& rule,
                                 const std::function<bool(const ConjugateResidualsReport&)>& go_on, Vector& x);

 private:
  std::vector<Vector> directions_,
      products_;  // p and A p, the latter orthonormal; kept, so that they need no room anew
  Vector residual_;
};

}  // namespace plica
