// The measure that a machine's time is given in: the plainest product of all element matrices with a vector.
#pragma once

#include "mesh.hpp"

namespace plica::reference {

/// The product itself, for those who time it otherwise. The mesh must outlive it.
class Yardstick {
 public:
  explicit Yardstick(const Mesh& mesh);
  void product();

 private:
  const Mesh& mesh_;
  std::vector<std::array<double, 24 * 24>> matrices_;
  std::vector<double> result_;
};

/// Median time of one product over the rounds, in microseconds: a dense 24 x 24 double matrix and a rotation a
/// hexahedron, each read from memory. Frees what it used.
double yardstick_us(const Mesh& mesh, int rounds = 9);

}  // namespace plica::reference
