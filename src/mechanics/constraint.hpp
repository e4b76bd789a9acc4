// What holds the tissue by equations: scalar functions of the nodes, each kept at its target by a multiplier.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "mechanics/law.hpp"

namespace plica {

/// What functions are sums of: parts that depend on a few nodes each (a cell's elements, a surface's facets).
struct ConstraintParts {
  NodeGroups nodes;           // of each part
  std::vector<int> function;  // that it belongs to; parts
};

/// A set of functions c_k(x) = target_k. A multiplier m_k pushes with m_k dc_k/dx; of a volume that is the pressure
/// inside. Functions are told apart by their place, 0 to count() - 1; spans of values, targets and multipliers are in
/// that order.
class Constraint {
 public:
  virtual ~Constraint() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Constraint> clone() const = 0;

  /// These, parts() and is_dense() stay as they are until a division. Targets may change between steps; none is 0,
  /// since errors are relative to it.
  [[nodiscard]] virtual std::size_t count() const = 0;
  [[nodiscard]] virtual std::span<const double> targets() const = 0;

  /// Whether a function depends on so many nodes (thousands) that its gradient times itself would fill a matrix.
  [[nodiscard]] virtual bool is_dense() const { return false; }

  /// Whether a step holds it, with multipliers among its unknowns. Else the projection does, or nothing.
  [[nodiscard]] virtual bool is_held() const { return true; }

  /// c_k at the given positions.
  virtual void values(std::span<const Vec3> positions, std::span<double> values) const = 0;

  [[nodiscard]] virtual ConstraintParts parts() const = 0;
  /// The gradient of each part by its nodes, part after part, node after node as in parts().
  virtual void gradients(std::span<const Vec3> positions, std::span<Vec3> of_parts) const = 0;

  /// Calls body(part) for every part; with `shared`, perhaps on several threads at once, for parts without a common
  /// node.
  virtual void for_parts(const std::function<void(std::size_t)>& body, bool shared) const = 0;

  /// Adds sum_k m_k dc_k/dx.
  virtual void add_forces(std::span<const Vec3> positions, std::span<const double> multipliers,
                          std::span<Vec3> forces) const = 0;
  /// Adds -sum_k m_k d2c_k/dx2 times `direction`.
  virtual void add_tangent_product(std::span<const Vec3> positions, std::span<const double> multipliers,
                                   std::span<const Vec3> direction, std::span<Vec3> product) const = 0;
  /// Adds -sum_k m_k d2c_k/dx2: blocks within parts.
  virtual void add_tangent(std::span<const Vec3> positions, std::span<const double> multipliers,
                           TangentSink& tangent) const = 0;

  /// |dc_k/dx|^2 at rest, about: by this, functions of any unit are weighed against each other and against forces.
  [[nodiscard]] virtual double gradient_scale(std::size_t function) const = 0;
  /// What rounding of positions (um) makes of c_k / target_k at most, over the functions: nothing solves below that.
  [[nodiscard]] virtual double rounding(const Tissue& tissue, double position_rounding) const = 0;

  /// The cell that a function is of, where it is of one: to say where something failed.
  [[nodiscard]] virtual std::optional<CellId> cell_of(std::size_t /*function*/) const { return std::nullopt; }

  /// The same for the tissue after a division, with nodes at `positions`.
  [[nodiscard]] virtual std::unique_ptr<Constraint> after_division(const Tissue& tissue, const Division& division,
                                                                   std::span<const Vec3> positions) const = 0;
  /// The multipliers after it.
  [[nodiscard]] virtual std::vector<double> multipliers_after_division(std::span<const double> multipliers,
                                                                       const Division& /*division*/) const {
    return {multipliers.begin(), multipliers.end()};
  }
};

}  // namespace plica
