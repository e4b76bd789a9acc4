// Approximate inverse of the linear system of a Newton iteration, computed at one iterate and kept over steps: that of
//   [ A             -J^T          ]
//   [ -J   -(gamma W)^-1          ],  W = 1/gradient_scale,
// in which multipliers are eliminated: A + gamma J^T W J is positive definite, and its factor (or multigrid) is in
// single precision. Later changes of contacts are borders (contact_border.hpp), as dense rows always are
// (dense_border.hpp). Derivation: docs/theory/step.md, Linear systems.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/preconditioner.hpp"
#include "solver/linear/chequerboard_factor.hpp"
#include "solver/linear/contact_border.hpp"
#include "solver/linear/dense_border.hpp"
#include "solver/linear/linearised_step.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

class KeptPreconditioner {
 public:
  enum class Inverse { cholesky, multigrid };

  /// Make a preconditioner of `system`, for steps with the patterns of `step`.
  KeptPreconditioner(const Model& model, const LinearisedStep& system, Inverse inverse, const Step& step);

  /// Whether the patterns of the laws are unchanged.
  [[nodiscard]] bool serves(const Step& step) const { return matrix_.serves(model_, step); }

  /// Recompute it at the present iterate of the system. False, and it is unusable, if no nearby matrix is positive
  /// definite.
  [[nodiscard]] bool make(const Step& step, const Iterate& at);

  /// Add changes of contacts since. False if it must be recomputed.
  [[nodiscard]] bool follow_contacts(const Iterate& at);

  /// Update the dense rows at the present iterate, one solve each. (With those of an older iterate, held exactly,
  /// solves took five more iterations.)
  void border_dense_rows();

  void apply(const KrylovVector& residual, KrylovVector& result) const;

  /// Return gamma W of the rows, a force over a length squared, divided by gradient_scale. For dense rows only a unit.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

 private:
  void weigh();
  [[nodiscard]] UninitialisedVector<float> rigid_motions(const Iterate& at) const;
  void apply_inverse(std::span<Vec3> x) const;
  void apply_sparse(std::span<Vec3> dx, std::span<double> multipliers) const;

  const Model& model_;
  const LinearisedStep& system_;
  Inverse inverse_;
  StepMatrix matrix_;  // with its J, at the iterate of the inverse
  std::unique_ptr<Preconditioner> preconditioner_;
  const BlockCholesky* factor_ = nullptr;  // the factor, if it is one, with its border
  ContactBorder contacts_;
  std::optional<ChequerboardFactor> chequerboards_;  // for modes that gamma W does not resist
  DenseBorder dense_;
  std::vector<char> in_contact_;  // contacts at the iterate of the inverse
  std::vector<double> weights_;   // rows

  mutable std::vector<double> chequered_;  // scratch
  mutable Vectors moved_;
  mutable std::vector<float> single_;
  UninitialisedVector<float> values_;
};

}  // namespace plica
