// Newton directions by conjugate residuals on the products of the laws: the system is not assembled, only what
// preconditions it. That is an approximate inverse of the regularised system
//   [ A             -J^T          ]
//   [ -J   -(gamma W)^-1          ],  W = 1/target volume,
// in which pressures are eliminated: A + gamma J^T W J is positive definite, and its factor (or multigrid), in single
// precision, is kept over steps while it serves. Derivation: docs/theory/step.md, Linear systems.
#pragma once

#include "core/uninitialised.hpp"
#include "solver/algebra/conjugate_residuals.hpp"
#include "solver/algebra/preconditioner.hpp"
#include "solver/linear/contact_border.hpp"
#include "solver/linear/pressure_factor.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

class KrylovDirections final : public NewtonDirections {
 public:
  enum class Inverse { cholesky, multigrid };

  KrylovDirections(const Model& model, Inverse inverse, std::function<bool()> stop_requested);
  [[nodiscard]] Outcome find(const Step& step, const Iterate& at, const Residual& residual, const Wish& wish,
                             Direction& direction, Cost& cost) override;
  void forget_factor() override { has_factor_ = false; }
  [[nodiscard]] FactorMemory memory() const override;
  void recall(const FactorMemory& memory) override;

 private:
  // Three numbers a node, then one a cell. Forces are 0 on hanging nodes, directions are where the free nodes say.
  using Vector = ConjugateResiduals::Vector;
  [[nodiscard]] std::span<Vec3> of_nodes(Vector& vector) const;
  [[nodiscard]] std::span<const Vec3> of_nodes(const Vector& vector) const;
  [[nodiscard]] std::span<double> of_cells(Vector& vector) const;
  [[nodiscard]] std::span<const double> of_cells(const Vector& vector) const;

  void linearise(const Iterate& at);
  bool follow_contacts(const Iterate& at);
  bool refresh(const Step& step, const Iterate& at);
  void weigh_pressures();
  [[nodiscard]] UninitialisedVector<float> rigid_motions(const Iterate& at) const;
  void multiply(const Step& step, const Iterate& at, const Vector& direction, Vector& product) const;
  void set_right_side(const Residual& residual);
  /// dx (A + gamma J^T W J) dx of a direction, by its product: below 0 only where the sheet is not stable.
  [[nodiscard]] double curvature(const Vector& direction, const Vector& product) const;
  /// How many of a solve's iterations a new factor would have saved.
  [[nodiscard]] int wasted(const ConjugateResidualsReport& solve) const;
  void apply_inverse(std::span<Vec3> x) const;
  void precondition(const Vector& residual, Vector& result) const;
  void project(std::span<Vec3> vectors) const;

  const Model& model_;
  std::function<bool()> stop_requested_;
  Inverse inverse_;
  std::size_t nodes_;
  StepMatrix matrix_;  // with its J, where the factor was made
  std::unique_ptr<Preconditioner> preconditioner_;
  const BlockCholesky* factor_ = nullptr;  // it, where it is one; with its border
  ContactBorder border_;
  std::optional<PressureFactor> pressures_;  // for what gamma W does not see
  bool has_factor_ = false;
  FactorMemory made_from_;       // without what came later
  int price_of_factor_;          // in iterations that take as long, with the assembly
  int iterations_when_new_ = 0;  // to 1e-4
  int wasted_iterations_ = 0;

  std::vector<double> pressure_weights_;  // gamma W as in the factor; cells, kPa/um^3
  double volume_unit_ = 1;                // nN/um^3: makes the rows of volumes forces

  // Where Newton's method stands.
  VolumeJacobian jacobian_;
  std::vector<NodeFrame> frames_;
  std::vector<std::size_t> fixed_nodes_;
  std::vector<std::pair<std::size_t, Mat3>> contact_tangents_;  // by node

  ConjugateResiduals solver_;
  Vector right_, solution_;
  mutable std::vector<double> chequered_;  // scratch
  mutable Vectors moved_;
  mutable std::vector<float> single_;
  UninitialisedVector<float> values_;
};

}  // namespace plica
