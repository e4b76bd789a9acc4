// Matrix-free linear system of a Newton iteration:
//   [ A  -J^T ] [ dx           ]
//   [ -J   0  ] [ dmultipliers ]
// at an iterate, without fixed directions of nodes. Constraint rows are scaled to units of force, so one norm measures
// the whole residual.
#pragma once

#include <span>
#include <vector>

#include "solver/algebra/krylov.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {

class LinearisedStep {
 public:
  explicit LinearisedStep(const Model& model);

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
  void take(const Step& step, const Iterate& at);

  [[nodiscard]] const Contacts& contacts() const { return contacts_; }
  [[nodiscard]] const std::vector<NodeFrame>& frames() const { return frames_; }
  /// Return the last iterate.
  [[nodiscard]] const ConstraintJacobian& jacobian() const { return jacobian_; }

  /// Remove the components along fixed directions from vectors of nodes.
  void project(std::span<Vec3> vectors) const;

  /// Return the scale of a row of J from its weight (a force over a length squared, divided by gradient_scale).
  void set_units(std::span<const double> weights);
  [[nodiscard]] std::span<const double> units() const { return units_; }

  void multiply(const Step& step, const Iterate& at, const KrylovVector& direction, KrylovVector& product) const;
  [[nodiscard]] KrylovVector right_side(const Residual& residual) const;
  [[nodiscard]] Direction direction_of(const KrylovVector& solution, std::size_t multipliers) const;

  /// Return dx (A + J^T W J) dx of a direction from its product; negative only if the sheet is unstable.
  [[nodiscard]] double curvature(const KrylovVector& direction, const KrylovVector& product,
                                 std::span<const double> weights) const;

 private:
  const Model& model_;
  std::size_t nodes_;
  Contacts contacts_;
  ConstraintJacobian jacobian_;
  std::vector<double> units_;  // rows
  std::vector<NodeFrame> frames_;
  std::vector<std::size_t> fixed_nodes_;
  std::vector<std::pair<std::size_t, Mat3>> contact_tangents_;  // by node
};

}  // namespace plica
