// What presses the sheet inwards at t = 0: the springs' force on each node of the midline over the area around it,
// against Laplace's law (PAPER note 9), and what meshes and formulas come to before anything moves.
#pragma once

#include "paper/measures.hpp"
#include "show/plot.hpp"

namespace plica {

/// Figures laplace.*, and inward force per area along the midline: pill and sphere with the same springs on every cell
/// and in both directions, and the pill with the chosen reading's and with axial springs on the strip.
struct Mechanism {
  Figures figures;
  Plot plot;
};

Mechanism mechanism();

/// Figures mesh.*: counts, sizes and the sum of <X, grad V> over V, all of the meshes at rest.
Figures mesh_figures();

}  // namespace plica
