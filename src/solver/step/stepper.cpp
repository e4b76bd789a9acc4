#include "solver/step/stepper.hpp"

#include <fmt/format.h>

#include "core/parallel.hpp"

namespace plica {

std::string StepReport::reason() const {
  const std::string where = cell ? fmt::format("cell {}", cell->number()) : "an unknown cell";
  switch (status) {
    case Status::converged:
      return "converged";
    case Status::inverted_element:
      return where + " is inverted";
    case Status::no_convergence:
      return "Newton's method does not converge; largest force residual in " + where;
    case Status::no_linear_convergence:
      return "conjugate gradients do not converge; largest force in " + where;
    case Status::singular_system:
      return "the linear system is singular (redundant constraints, or an unconstrained rigid-body motion); largest "
             "force in " +
             where;
    case Status::not_projected:
      return fmt::format(
          "the projection does not converge in {} sweeps: relative error {:.1e} in the volume of {}, a node {:.1e} um "
          "outside the shell",
          projection_sweeps, constraint_error, cell ? where : "the whole surface", outside_um);
    case Status::not_finite:
      return "a force in " + where + " is not finite";
    case Status::interrupted:
      return "interrupted";
  }
  return "";
}

std::string StepReport::remedy() const {
  switch (status) {
    case Status::inverted_element:
      return "set elasticity.corner_barrier_Pa (100, say), and let forces rise over minutes (`program`); only if both "
             "fail, reduce the forces there or raise elasticity.young_modulus_Pa";
    case Status::no_convergence:
      return "set elasticity.corner_barrier_Pa (100, say), and let forces rise over minutes (`program`); only if both "
             "fail, reduce the forces there or shorten time.max_step_s";
    case Status::no_linear_convergence:
      return "shorten time.step_s, or raise time.cg_max_iterations";
    case Status::not_projected:
      return "shorten time.step_s";
    case Status::singular_system:
      return "hold each node once (`[hold.NAME]`), or hold or drag what can move freely "
             "(dynamics.surface_drag_Pa_s_per_um)";
    default:
      return "";
  }
}

std::optional<CellId> cell_with_largest(const Tissue& tissue, std::span<const Vec3> vectors) {
  std::size_t largest = 0;
  for (std::size_t n = 0; n < vectors.size(); ++n) {
    if (!vectors[n].allFinite()) {
      largest = n;
      break;
    }
    if (vectors[n].squaredNorm() > vectors[largest].squaredNorm()) largest = n;
  }
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    for (const NodeId node : tissue.elements[e])
      if (node.index() == largest) return tissue.element_cell[e];
  return std::nullopt;
}

std::optional<CellId> inverted_cell(const Tissue& tissue, const Vectors& positions) {
  const std::size_t element = parallel_find(
      tissue.elements.size(), [&](std::size_t e) { return !hex_is_upright(gather(positions, tissue.elements[e])); });
  return element < tissue.elements.size() ? std::optional(tissue.element_cell[element]) : std::nullopt;
}

}  // namespace plica
