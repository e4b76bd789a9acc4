// Residual of an iterate of a step, and the contact states of nodes.
#pragma once

#include "mechanics/model.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {

/// Convergence tolerances of a step.
struct StepTolerances {
  double force = 1e-8;        // residual / norm of the balancing forces
  double constraint = 1e-10;  // |value/target - 1| of every held function
  double gap_um = 1e-8;       // penetration of a node into an obstacle
  int max_iterations = 40;
};

class Balance {
 public:
  Balance(const Model& model, const StepTolerances& tolerances);

  /// Compute the residual and sets the contact forces of the iterate: obstacles bear the forces that push nodes
  /// outward along their normals.
  [[nodiscard]] Residual residual(const Step& step, Iterate& at) const;

  [[nodiscard]] bool is_solved(const Residual& residual) const;

  /// Release nodes pulled inward, adds nodes outside, and projects all onto their obstacles. Returns whether any
  /// contact changed. `changes`: contacts; number of changes in this step, updated here.
  bool revise_contacts(Iterate& at, std::span<unsigned char> changes) const;

  [[nodiscard]] const Contacts& contacts() const { return contacts_; }

 private:
  void add_contact_forces(Iterate& at, std::span<const Vec3> others, std::span<Vec3> forces) const;
  void take_out_normals(const Iterate& at, std::span<Vec3> forces) const;

  const Model& model_;
  StepTolerances tolerances_;
  Contacts contacts_;
  double force_scale_;                       // nN
  double position_rounding_;                 // um
  double elastic_rounding_;                  // nN: resulting error of elastic forces
  std::vector<double> constraint_rounding_;  // resulting error of relative values; constraints
};

}  // namespace plica
