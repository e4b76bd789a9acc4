// Checks that hold for every law: forces are minus the gradient of the energy, the tangent is the gradient of that, the
// matrix-free and the assembled tangent are one, and it is symmetric.
#pragma once

#include "mechanics/law.hpp"
#include "support/tissues.hpp"

namespace plica::support {

/// A law's assembled tangent as a full matrix, and how often each block was given.
class DenseTangent final : public TangentSink {
 public:
  DenseTangent(const Law& law, const Step& step);
  void add_block(NodeId row, NodeId column, const Mat3& block) override;
  Eigen::MatrixXd matrix;
};

Eigen::VectorXd flat(const Vectors& vectors);

Eigen::VectorXd product_of(const Law& law, const Step& step, const Vectors& direction);

/// Central differences at 1e-4 um: their own error is about (1e-4/20)^2 of the force by truncation and 1e-16 times the
/// energy over 1e-4 by rounding, both below 1e-7 of the forces of these tests.
inline constexpr double difference_um = 1e-4;

void expect_forces_are_minus_energy_gradient(const Law& law, Motion motion, double tolerance);
void expect_tangent_is_minus_force_gradient(const Law& law, Motion motion, double tolerance);
void expect_assembled_is_matrix_free(const Law& law, const Motion& motion, unsigned seed);

/// All of them, at random large deformations and rotations; `size_um` is how far nodes move. Of a law that does not
/// refuse gradients, check_law_derivatives too.
void check_derivatives(const Law& law, const Tissue& tissue, double size_um, int cases = 3, double tolerance = 1e-6);

/// Whether a law has derivatives for gradients of runs, instead of refusing with its name.
bool has_derivatives(const Law& law);

/// Derivatives of forces and of the internal state by what a step begins with, and by strengths of (some) cells if it
/// has any, at random large motions of both orders; `internal`: the state at its beginning, whose numbers -1 are marks.
/// Without `with_memory`, those of the internal state are left out.
void check_law_derivatives(const Law& law, const Tissue& tissue, double size_um, const std::vector<double>& internal,
                           double tolerance = 1e-7, bool with_memory = true);

/// The semidefinite tangent at random large deformations: both forms of it are one, it is symmetric, no direction has
/// negative stiffness, and forces do not change. `exact_is_indefinite`: whether some of these motions need it.
void check_semidefinite_tangent(const Law& law, const Tissue& tissue, double size_um, bool exact_is_indefinite,
                                int cases = 5);

/// The law's energy flow over a short step is the work of its forces, which are right to second order both, so they
/// differ by the third power of the size of the step.
void check_energy_flow(const Law& law, const Tissue& tissue);

/// The resultant of forces, and their torque about the origin.
Vec3 resultant(const Vectors& forces);
Vec3 torque(const Vectors& forces, std::span<const Vec3> positions);

/// Neither of both at five random motions, as of every law that only knows the body itself.
void expect_no_resultant_and_no_torque(const Law& law, const Tissue& tissue, double size_um);

}  // namespace plica::support
