#include "stepping.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace plica::reference {
namespace {

constexpr int most_iterations = 2000;
constexpr double update_cost = 8;      // of making a preconditioner, in applications of it, about
constexpr std::size_t remembered = 2;  // a line; one or three cost up to an eighth more iterations

// Sums in lanes, in an order fixed by the build.
double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
#pragma omp simd reduction(+ : sum)
  for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
  return sum;
}

// Interface as plica::Preconditioner.
std::vector<float> rigid_motions(const std::vector<double>& nodes) {
  const double count = static_cast<double>(nodes.size() / 3);
  double middle[3] = {}, squares = 0;
  for (std::size_t k = 0; k < nodes.size(); ++k) middle[k % 3] += nodes[k] / count;
  for (std::size_t k = 0; k < nodes.size(); ++k) squares += std::pow(nodes[k] - middle[k % 3], 2);
  const double radius = std::sqrt(squares / count);
  std::vector<float> motions;
  for (std::size_t n = 0; n < nodes.size(); n += 3) {
    float x[3];
    for (int c = 0; c < 3; ++c) x[c] = static_cast<float>((nodes[n + c] - middle[c]) / radius);
    motions.insert(motions.end(), {1, 0, 0, 0, x[2], -x[1],  //
                                   0, 1, 0, -x[2], 0, x[0],  //
                                   0, 0, 1, x[1], -x[0], 0});
  }
  return motions;
}

}  // namespace

Stepper::Stepper(const Mesh& mesh, const Settings& settings, double tolerance)
    : tolerance_(tolerance),
      scene_(mesh, settings),
      preconditioner_(make_multigrid(scene_.pattern())),
      near_kernel_(rigid_motions(mesh.nodes)),
      single_(mesh.nodes.size()),
      x_(mesh.nodes),
      v_(x_.size()),
      b_(x_.size()),
      dv_(x_.size()),
      r_(x_.size()),
      z_(x_.size()),
      p_(x_.size()),
      Ap_(x_.size()) {
  update_preconditioner();
}

void Stepper::update_preconditioner() {
  std::vector<float> values;
  scene_.write_blocks(values);
  if (!preconditioner_->factorise(values, near_kernel_))
    throw std::runtime_error("the system is not positive definite");
  fewest_iterations_ = 0;
  excess_ = 0;
  ++report_.updates;
}

void Stepper::precondition() {
  std::copy(r_.begin(), r_.end(), single_.begin());
  preconditioner_->solve(single_);
  std::copy(single_.begin(), single_.end(), z_.begin());
}

// Linear extrapolation of dv from the last steps.
void Stepper::guess() {
  constexpr double weights[remembered][remembered] = {{1, 0}, {2, -1}};
  std::fill(dv_.begin(), dv_.end(), 0.0);
  for (std::size_t k = 0; k < history_.size(); ++k)
    for (std::size_t n = 0; n < dv_.size(); ++n) dv_[n] += weights[history_.size() - 1][k] * history_[k][n];
}

void Stepper::step() {
  scene_.turn_to(x_);
  scene_.right_hand_side(x_, v_, b_);
  // An update pays when the iterations it would have saved so far cost as much.
  if (excess_ > update_cost) update_preconditioner();
  guess();
  const SolveReport solved = solve();
  if (!(solved.residual <= tolerance_))
    throw std::runtime_error("a system was not solved: residual " + std::to_string(solved.residual));

  if (fewest_iterations_ == 0 || solved.iterations < fewest_iterations_) fewest_iterations_ = solved.iterations;
  excess_ += solved.iterations - fewest_iterations_;
  report_.iterations += solved.iterations;
  report_.residual = std::max(report_.residual, solved.residual);

  if (history_.size() == remembered)
    std::rotate(history_.begin(), history_.end() - 1, history_.end());
  else
    history_.insert(history_.begin(), dv_);
  history_.front() = dv_;
  const double h = scene_.settings().step;
  for (std::size_t n = 0; n < x_.size(); ++n) {
    v_[n] += dv_[n];
    x_[n] += h * v_[n];
  }
}

// Conjugate gradients tolerant of rounding in the preconditioner (Polak-Ribiere). At the end of the recurrence the
// residual is recomputed, and iterations continue if it is too large.
SolveReport Stepper::solve() {
  SolveReport report;
  const double size = std::sqrt(dot(b_, b_));
  const auto true_residual = [&] {
    scene_.multiply(dv_, Ap_);
    for (std::size_t n = 0; n < r_.size(); ++n) r_[n] = b_[n] - Ap_[n];
    return size == 0 ? 0 : std::sqrt(dot(r_, r_)) / size;
  };
  report.residual = true_residual();
  while (report.residual > tolerance_ && report.iterations < most_iterations) {
    double rz = 0;
    std::fill(p_.begin(), p_.end(), 0.0);
    for (double estimate = report.residual; estimate > tolerance_ && report.iterations < most_iterations;) {
      precondition();
      const double next = dot(r_, z_);
      const double beta = rz == 0 ? 0 : (next - dot(z_, Ap_)) / rz;  // Ap_ holds the last residual
      rz = next;
      for (std::size_t n = 0; n < p_.size(); ++n) p_[n] = z_[n] + beta * p_[n];
      scene_.multiply(p_, z_);
      const double alpha = rz / dot(p_, z_);
      for (std::size_t n = 0; n < r_.size(); ++n) {
        dv_[n] += alpha * p_[n];
        Ap_[n] = r_[n];
        r_[n] -= alpha * z_[n];
      }
      estimate = std::sqrt(dot(r_, r_)) / size;
      ++report.iterations;
    }
    report.residual = true_residual();
  }
  return report;
}

}  // namespace plica::reference
