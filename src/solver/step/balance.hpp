// What is unbalanced at an iterate of a step, and which nodes touch obstacles there.
#pragma once

#include "mechanics/model.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {

/// When a step counts as solved.
struct StepTolerances {
  double force = 1e-8;        // residual over the norm of the forces that balance
  double constraint = 1e-10;  // |value/target - 1|, every function that is held
  double gap_um = 1e-8;       // depth of a node beyond an obstacle
  int max_iterations = 40;
};

class Balance {
 public:
  Balance(const Model& model, const StepTolerances& tolerances);

  /// Sets the iterate's contact forces: obstacles bear what else would push nodes outward along their normals.
  [[nodiscard]] Residual residual(const Step& step, Iterate& at) const;

  [[nodiscard]] bool is_solved(const Residual& residual) const;

  /// Lets nodes go that are pulled inward, takes up those that are outside, and puts all on their obstacles. Whether
  /// any has changed. `changes`: contacts; how often each has in this step, counted here.
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
  double elastic_rounding_;                  // nN: what that makes of elastic forces
  std::vector<double> constraint_rounding_;  // the same of relative values; constraints
};

}  // namespace plica
