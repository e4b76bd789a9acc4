// Vitelline membrane: a rigid, frictionless shell around the embryo. Every apical node keeps a gap g(x) >= 0 to it.
// Inward motion is free; there is no adhesion (shell_drag.hpp slows sliding). Theory: docs/theory/vitelline.md.
#pragma once

#include <vector>

#include "core/ids.hpp"
#include "mechanics/obstacle.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Return the narrowest capsule along x around all reference nodes: the shell of a mesh from a file, which should be
/// centred on the x axis. (Slightly off for built pills and spheres, whose shell bulges between nodes.)
Capsule enclosing_capsule(const Vectors& positions);

class Vitelline final : public Obstacle {
 public:
  /// Make the obstacle for the nodes of the apical surface.
  Vitelline(const Tissue& tissue, const OuterShape& shell);

  [[nodiscard]] std::string_view name() const override { return "vitelline"; }
  [[nodiscard]] std::unique_ptr<Obstacle> clone() const override { return std::make_unique<Vitelline>(*this); }
  [[nodiscard]] std::span<const NodeId> nodes() const override { return nodes_; }
  [[nodiscard]] Gap gap(const Vec3& position) const override { return shell_.gap(position); }
  [[nodiscard]] std::unique_ptr<Obstacle> after_change(const Tissue& tissue, const TissueChange&) const override {
    return std::make_unique<Vitelline>(tissue, shell_);
  }

  [[nodiscard]] const OuterShape* shell() const override { return &shell_; }

 private:
  OuterShape shell_;
  std::vector<NodeId> nodes_;
};

}  // namespace plica
