// Matrix-free linear system of a Newton iteration:
//   [ A  -J^T ] [ dx           ]
//   [ -J   0  ] [ dmultipliers ]
// at an iterate, without fixed directions of nodes. Constraint rows are scaled to units of force, so one norm measures
// the whole residual.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "solver/algebra/krylov.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {

class LinearisedSystem {
 public:
  explicit LinearisedSystem(const Model& model)
      : model_(model),
        nodes_(model.tissue.node_count()),
        contacts_(model),
        jacobian_(model),
        units_(jacobian_.rows(), 1.0) {}

  // Vectors have three numbers per node, then one per row of J. Forces are 0 on hanging nodes; their directions follow
  // from the free nodes.
  [[nodiscard]] std::size_t size() const { return 3 * nodes_ + jacobian_.rows(); }
  [[nodiscard]] std::span<Vec3> of_nodes(std::span<double> vector) const {
    static_assert(sizeof(Vec3) == 3 * sizeof(double));
    return {reinterpret_cast<Vec3*>(vector.data()), nodes_};
  }
  [[nodiscard]] std::span<Vec3> of_nodes(KrylovVector& vector) const { return of_nodes(std::span(vector)); }
  [[nodiscard]] std::span<const Vec3> of_nodes(const KrylovVector& vector) const {
    return {reinterpret_cast<const Vec3*>(vector.data()), nodes_};
  }
  [[nodiscard]] std::span<double> of_rows(std::span<double> vector) const { return vector.subspan(3 * nodes_); }
  [[nodiscard]] std::span<double> of_rows(KrylovVector& vector) const { return of_rows(std::span(vector)); }
  [[nodiscard]] std::span<const double> of_rows(const KrylovVector& vector) const {
    return std::span(vector).subspan(3 * nodes_);
  }

  /// Move to an iterate.
  void take(const Step& step, const Iterate& at) {
    frames_ = node_frames(model_, contacts_, at);
    fixed_nodes_.clear();
    for (std::size_t n = 0; n < frames_.size(); ++n)
      if (frames_[n].fixed > 0) fixed_nodes_.push_back(n);
    obstacle_tangents_.clear();
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k)
      if (at.on_obstacle[k])
        obstacle_tangents_.emplace_back(contacts_.node(k).index(),
                                        -at.obstacle_forces[k] * contacts_.gap(k, at.positions).hessian);
    jacobian_.update(at_end(model_, step), at.positions);
  }

  [[nodiscard]] const ObstacleContacts& contacts() const { return contacts_; }
  [[nodiscard]] const std::vector<NodeFrame>& frames() const { return frames_; }
  /// Return the last iterate.
  [[nodiscard]] const ConstraintJacobian& jacobian() const { return jacobian_; }

  /// Remove the components along fixed directions from vectors of nodes.
  void project(std::span<Vec3> vectors) const {
    parallel_for(fixed_nodes_.size(), [&](std::size_t k) {
      const std::size_t n = fixed_nodes_[k];
      vectors[n] = frames_[n].free_part(vectors[n]);
    });
  }

  /// Return the scale of a row of J from its weight (a force over a length squared, divided by gradient_scale).
  void set_units(std::span<const double> weights) {
    // Mean over the functions of a constraint, so that they stay comparable.
    for (const auto& [first, last] : jacobian_.blocks()) {
      double sum = 0;
      for (std::size_t row = first; row < last; ++row) sum += weights[row] * std::sqrt(jacobian_.gradient_scale(row));
      std::fill(units_.begin() + first, units_.begin() + last, sum / static_cast<double>(last - first));
    }
  }
  [[nodiscard]] std::span<const double> units() const { return units_; }

  void multiply(const Step& step, const Iterate& at, const KrylovVector& direction, KrylovVector& product) const {
    const std::span<Vec3> forces = of_nodes(product);
    multiply_unprojected(step, at, direction, forces);
    project(forces);
    const std::span<double> rates = of_rows(product);
    jacobian_.rates(of_nodes(direction), rates);
    parallel_for(rates.size(), [&](std::size_t row) { rates[row] *= -units_[row]; });
  }
  /// Set forces to A dx - J^T dmultipliers, along fixed directions as well.
  void multiply_unprojected(const Step& step, const Iterate& at, const KrylovVector& direction,
                            std::span<Vec3> forces) const {
    const std::span<const Vec3> dx = of_nodes(direction);
    parallel_for(forces.size(), [&](std::size_t n) { forces[n].setZero(); });
    for_laws(model_, step,
             [&](const Law& law, const Step& law_step) { law.add_tangent_product(law_step, dx, forces); });
    if (!step.semidefinite_tangent)
      for_held_constraints(model_, [&](const Constraint& constraint, std::size_t first, std::size_t) {
        constraint.add_tangent_product(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), dx,
                                       forces);
      });
    model_.tissue.carry_hanging(forces);
    for (const auto& [node, tangent] : obstacle_tangents_) forces[node] += tangent * dx[node];
    jacobian_.add_forces(of_rows(direction), -1, forces);
  }
  [[nodiscard]] KrylovVector right_side(const Residual& residual) const {
    KrylovVector right(size());
    std::ranges::copy(residual.forces, of_nodes(right).begin());
    project(of_nodes(right));
    const std::span<double> rows = of_rows(right);
    for (std::size_t row = 0; row < rows.size(); ++row)
      rows[row] = -units_[row] * residual.deficits[jacobian_.multiplier(row)];
    return right;
  }
  [[nodiscard]] Direction direction_of(const KrylovVector& solution, std::size_t multipliers) const {
    Direction direction;
    direction.positions.assign(of_nodes(solution).begin(), of_nodes(solution).end());
    direction.multipliers.assign(multipliers, 0.0);
    const std::span<const double> rows = of_rows(solution);
    for (std::size_t row = 0; row < rows.size(); ++row) direction.multipliers[jacobian_.multiplier(row)] = rows[row];
    return direction;
  }

  /// Return dx (A + J^T W J) dx of a direction from its product; negative only if the sheet is unstable.
  [[nodiscard]] double curvature(const KrylovVector& direction, const KrylovVector& product,
                                 std::span<const double> weights) const {
    // The product's parts are A dx - J^T dmultipliers and -units J dx.
    const std::size_t numbers = 3 * nodes_;
    double sum = parallel_dot(std::span(direction).first(numbers), std::span(product).first(numbers));
    const std::span<const double> multipliers = of_rows(direction), rates = of_rows(product);
    for (std::size_t row = 0; row < rates.size(); ++row) {
      const double rate = -rates[row] / units_[row];
      sum += rate * (multipliers[row] + weights[row] * rate);
    }
    return sum;
  }

 private:
  const Model& model_;
  std::size_t nodes_;
  ObstacleContacts contacts_;
  ConstraintJacobian jacobian_;
  std::vector<double> units_;  // rows
  std::vector<NodeFrame> frames_;
  std::vector<std::size_t> fixed_nodes_;
  std::vector<std::pair<std::size_t, Mat3>> obstacle_tangents_;  // by node
};

}  // namespace plica
