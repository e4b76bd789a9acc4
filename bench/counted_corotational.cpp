#include "counted_lanes.hpp"
// After that, which decides what they are made of:
#include "counted_kernels.hpp"
#include "mechanics/kernels/corotational_blocks_kernels.cpp"
#include "mechanics/kernels/corotational_kernels.cpp"

namespace plica::counted {

const CorotationalKernels& corotational() { return corotational_kernels; }

long take_count() {
  const long taken = operations;
  operations = 0;
  return taken;
}

}  // namespace plica::counted
