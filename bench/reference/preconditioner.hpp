// What makes the scene's systems easy for conjugate gradients.
#pragma once

#include <memory>
#include <span>

#include "scene.hpp"

namespace plica::reference {

class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Made anew for the scene's present frames and springs. Throws std::runtime_error when that is not possible.
  virtual void update(const Scene& scene, std::span<const double> x) = 0;
  /// z = B r, B symmetric positive definite and near A^-1.
  virtual void apply(std::span<const double> r, std::span<double> z) const = 0;
  /// How many applications an update costs, about.
  [[nodiscard]] virtual double update_cost() const = 0;
};

/// Geometric multigrid in single precision; on a mesh of few nodes a Cholesky factor of all of A.
std::unique_ptr<Preconditioner> make_multigrid(const Scene& scene);

}  // namespace plica::reference
