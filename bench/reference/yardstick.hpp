// The measure that a machine's time is given in: the plainest product of all element matrices with a vector.
#pragma once

#include "mesh.hpp"

namespace plica::reference {

/// Median time of one product over the rounds, in microseconds: a dense 24 x 24 double matrix and a rotation a
/// hexahedron, each read from memory. Frees what it used.
double yardstick_us(const Mesh& mesh, int rounds = 9);

}  // namespace plica::reference
