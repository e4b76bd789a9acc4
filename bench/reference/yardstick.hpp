// Unit of time of a machine: the plainest product of all element matrices with a vector.
#pragma once

#include "mesh.hpp"

namespace plica::reference {

/// The product itself, for other timings. The mesh must outlive it.
class Yardstick {
 public:
  explicit Yardstick(const Mesh& mesh);
  void product();

 private:
  const Mesh& mesh_;
  std::vector<std::array<double, 24 * 24>> matrices_;
  std::vector<double> result_;
};

/// Median time of one product over the rounds, in microseconds: a dense 24 x 24 double matrix and a rotation per
/// hexahedron, each read from memory. Frees its memory.
double yardstick_us(const Mesh& mesh, int rounds = 9);

}  // namespace plica::reference
