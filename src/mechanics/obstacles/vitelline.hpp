// The vitelline layer: a rigid, frictionless shell around the embryo. Every apical node keeps a gap g(x) >= 0 to it.
// Inward motion is free; there is no sticking. Theory: docs/theory/vitelline.md.
#pragma once

#include <vector>

#include "core/ids.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// The narrowest capsule along x around all nodes at rest: the shell of a mesh from a file, which is meant to be
/// centred on the x axis. (Of a pill or a sphere it is a little off: between two nodes their shell bulges.)
Capsule enclosing_capsule(const Vectors& positions);

class Vitelline {
 public:
  /// A capsule or ball; the nodes are the free ones of the tissue's apical surface (what hangs lies between them).
  Vitelline(const Tissue& tissue, const Capsule& shell);

  /// A node's gap to the shell (positive inside, um), its gradient (unit inward normal) and Hessian (1/um).
  struct Gap {
    double value;
    Vec3 inward;
    Mat3 hessian;
  };
  [[nodiscard]] Gap gap(const Vec3& position) const;

  [[nodiscard]] const std::vector<NodeId>& nodes() const { return nodes_; }
  [[nodiscard]] const Capsule& shell() const { return shell_; }

 private:
  Capsule shell_;
  std::vector<NodeId> nodes_;
};

}  // namespace plica
