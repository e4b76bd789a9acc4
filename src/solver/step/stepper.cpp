#include "solver/step/stepper.hpp"

#include <fmt/format.h>

#include "core/parallel.hpp"

namespace plica {

std::string StepReport::reason() const {
  const std::string where = cell ? fmt::format("cell {}", cell->number()) : "an unknown cell";
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::inverted_element:
      return where + " turns inside out";
    case Outcome::no_convergence:
      return "forces and volumes cannot be balanced (Newton's method does not converge); worst in " + where;
    case Outcome::no_linear_convergence:
      return "conjugate gradients do not converge; largest force in " + where;
    case Outcome::singular_system:
      return "the linear system is singular (something is held twice, or by nothing); largest force in " + where;
    case Outcome::not_projected:
      return fmt::format(
          "volumes and shell are not met after {} sweeps of projection: the volume of {} is off by {:.1e}, a node is "
          "{:.1e} um outside the shell",
          projection_sweeps, cell ? where : "the whole surface", constraint_error, outside_um);
    case Outcome::not_finite:
      return "a force in " + where + " is not a finite number";
    case Outcome::interrupted:
      return "interrupted";
  }
  return "";
}

std::string StepReport::remedy() const {
  switch (outcome) {
    case Outcome::inverted_element:
      return "it is pulled or pushed more than its shape bears: lower stiffness_nN_per_um, preload_nN, "
             "tension_mN_per_m or pressure_Pa of what acts there (by halves, say), raise elasticity.young_modulus_Pa, "
             "or give it more elements (embryo.elements_per_cell; of polygons, embryo.elements = \"kites\")";
    case Outcome::no_convergence:
      return "lower the forces that act there, raise elasticity.young_modulus_Pa, or give a shorter time.max_step_s";
    case Outcome::no_linear_convergence:
      return "give a shorter time.step_s, or a larger time.cg_max_iterations";
    case Outcome::not_projected:
      return "give a shorter time.step_s";
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
