// Inward pressure at t = 0: spring force per area at midline nodes compared with Laplace's law (PAPER note 9), and
// figures of undeformed meshes.
#pragma once

#include "paper/measures.hpp"
#include "show/plot.hpp"

namespace plica {

/// Figures laplace.* and inward force per area along the midline: pill and sphere with equal springs on every cell in
/// both directions; pill with the springs of the chosen reading, and with axial springs, on the strip.
struct Mechanism {
  Figures figures;
  Plot plot;
};

Mechanism mechanism();

/// Figures mesh.* of undeformed meshes: counts, sizes and the sum of <X, grad V> / V.
Figures mesh_figures();

}  // namespace plica
