// An approximate inverse of the linear system of a Newton iteration, made for one iterate and kept over steps: that of
//   [ A             -J^T          ]
//   [ -J   -(gamma W)^-1          ],  W = 1/gradient_scale,
// in which multipliers are eliminated: A + gamma J^T W J is positive definite, and its factor (or multigrid) is in
// single precision. What has changed since is borders: contacts (contact_border.hpp), and dense rows always
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

  /// `system`: whose inverse it is. For steps in which the laws' patterns are those of `step`.
  KeptPreconditioner(const Model& model, const LinearisedStep& system, Inverse inverse, const Step& step);

  /// Whether the laws' patterns are still those that it was made for.
  [[nodiscard]] bool serves(const Step& step) const { return matrix_.serves(model_, step); }

  /// Makes it anew for where the system is. False, and it is of no use, when no matrix near the tangent is positive
  /// definite.
  [[nodiscard]] bool make(const Step& step, const Iterate& at);

  /// Takes up the changes of contacts since. False when it should be made anew.
  [[nodiscard]] bool follow_contacts(const Iterate& at);

  /// Takes the dense rows of where the system is now: a solve each. (With those of an older iterate, exactly held, each
  /// solve of the system took five iterations more.)
  void border_dense_rows();

  void apply(const KrylovVector& residual, KrylovVector& result) const;

  /// gamma W; rows, a force over a length squared, over gradient_scale. Those of the dense rows serve as units only.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

  /// From what it was made, with the contacts since; and the same made again.
  [[nodiscard]] FactorMemory memory() const;
  [[nodiscard]] bool recall(const FactorMemory& memory);

 private:
  void weigh();
  [[nodiscard]] UninitialisedVector<float> rigid_motions(const Iterate& at) const;
  void apply_inverse(std::span<Vec3> x) const;
  void apply_sparse(std::span<Vec3> dx, std::span<double> multipliers) const;

  const Model& model_;
  const LinearisedStep& system_;
  Inverse inverse_;
  StepMatrix matrix_;  // with its J, where the inverse was made
  std::unique_ptr<Preconditioner> preconditioner_;
  const BlockCholesky* factor_ = nullptr;  // it, where it is one; with its border
  ContactBorder contacts_;
  std::optional<ChequerboardFactor> chequerboards_;  // for what gamma W does not see
  DenseBorder dense_;
  FactorMemory made_from_;
  std::vector<double> weights_;  // rows

  mutable std::vector<double> chequered_;  // scratch
  mutable Vectors moved_;
  mutable std::vector<float> single_;
  UninitialisedVector<float> values_;
};

}  // namespace plica
