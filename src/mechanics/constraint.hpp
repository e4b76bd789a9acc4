// Equality constraints: scalar functions of the nodes, each kept at its target by a Lagrange multiplier.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"
#include "mechanics/law.hpp"

namespace plica {

/// Parts that functions are sums of; each depends on a few nodes (elements of a cell, facets of a surface).
struct ConstraintParts {
  NodeGroups nodes;           // nodes of each part
  std::vector<int> function;  // index of the function; parts
};

/// Set of functions c_k(x) = target_k. A multiplier m_k exerts forces m_k dc_k/dx; for a volume it is the pressure
/// inside. Functions are identified by index, 0 to count() - 1, the order of spans of values, targets and multipliers.
class Constraint {
 public:
  virtual ~Constraint() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual std::unique_ptr<Constraint> clone() const = 0;

  /// Number of functions. count(), parts() and is_dense() are constant until a division; targets may change between
  /// steps and are never 0, since errors are relative to them.
  [[nodiscard]] virtual std::size_t count() const = 0;
  [[nodiscard]] virtual std::span<const double> targets() const = 0;

  /// Whether a function depends on so many nodes (thousands) that the outer product of its gradient would fill a
  /// matrix.
  [[nodiscard]] virtual bool is_dense() const { return false; }

  /// Whether steps solve for its multipliers; otherwise the projection enforces it, or nothing.
  [[nodiscard]] virtual bool is_held() const { return true; }

  /// Return c_k at the given positions.
  virtual void values(std::span<const Vec3> positions, std::span<double> values) const = 0;

  [[nodiscard]] virtual ConstraintParts parts() const = 0;
  /// Return the gradient of each part by its nodes, in the order of parts().
  virtual void gradients(std::span<const Vec3> positions, std::span<Vec3> of_parts) const = 0;

  /// Call body(part) for every part; if `shared`, possibly on several threads at once, for parts without common nodes.
  virtual void for_parts(const std::function<void(std::size_t)>& body, bool shared) const = 0;

  /// Add sum_k m_k dc_k/dx.
  virtual void add_forces(std::span<const Vec3> positions, std::span<const double> multipliers,
                          std::span<Vec3> forces) const = 0;
  /// Add -sum_k m_k d2c_k/dx2 times `direction`.
  virtual void add_tangent_product(std::span<const Vec3> positions, std::span<const double> multipliers,
                                   std::span<const Vec3> direction, std::span<Vec3> product) const = 0;
  /// Add -sum_k m_k d2c_k/dx2: blocks within parts.
  virtual void add_tangent(std::span<const Vec3> positions, std::span<const double> multipliers,
                           TangentSink& tangent) const = 0;

  /// Return |dc_k/dx|^2 in the reference state (approximate), which scales functions of any unit against each other
  /// and against forces.
  [[nodiscard]] virtual double gradient_scale(std::size_t function) const = 0;
  /// Return the largest relative error of c_k caused by rounding of positions (um): a lower bound for convergence.
  [[nodiscard]] virtual double rounding(const Tissue& tissue, double position_rounding) const = 0;

  /// Return the constraint for the tissue after a division, with nodes at `positions`.
  [[nodiscard]] virtual std::unique_ptr<Constraint> after_change(const Tissue& tissue, const TissueChange& change,
                                                                 std::span<const Vec3> positions) const = 0;
  [[nodiscard]] virtual std::vector<double> multipliers_after_division(std::span<const double> multipliers,
                                                                       const TissueChange& /*change*/) const {
    return {multipliers.begin(), multipliers.end()};
  }

  /// Return the fluid whose volume it holds; null for others.
  [[nodiscard]] virtual const EnclosedFluid* enclosed_fluid() const { return nullptr; }
};

}  // namespace plica
