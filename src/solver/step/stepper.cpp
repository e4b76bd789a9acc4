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
      return "the linear system is singular; largest force in " + where;
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
