// Steps of the reference scene: one linear system each, by preconditioned conjugate gradients.
#pragma once

#include <memory>

#include "scene.hpp"
#include "solver/algebra/linear_solver.hpp"

namespace plica::reference {

struct SolveReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|, recomputed in double precision
};

struct RunReport {
  long iterations = 0;
  int updates = 0;      // of the preconditioner
  double residual = 0;  // largest of any step
};

class Stepper {
 public:
  Stepper(const Mesh& mesh, const Settings& settings, double tolerance);

  /// Step: v += dv, x += h v. Throws std::runtime_error if the system is not solved to the tolerance.
  void step();

  [[nodiscard]] const std::vector<double>& positions() const { return x_; }
  [[nodiscard]] const RunReport& report() const { return report_; }

 private:
  void guess();
  SolveReport solve();
  void update_preconditioner();
  void precondition();  // z_ from r_

  double tolerance_;
  Scene scene_;
  std::unique_ptr<Preconditioner> preconditioner_;
  std::vector<float> near_kernel_, single_;
  std::vector<double> x_, v_, b_, dv_;
  std::vector<std::vector<double>> history_;  // of the last steps' dv, the newest first
  std::vector<double> r_, z_, p_, Ap_;
  int fewest_iterations_ = 0;  // of a step since the last update
  double excess_ = 0;          // iterations above them since then
  RunReport report_;
};

}  // namespace plica::reference
