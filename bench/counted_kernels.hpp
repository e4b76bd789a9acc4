// How many floating-point operations the kernels of src/mechanics/ take, counted by running them: their own sources,
// compiled with a number that counts what is done with it.
#pragma once

#include "mechanics/kernels/corotational_kernels.hpp"

namespace plica::counted {

/// The kernels, an element after the other. They count for the thread that calls them.
const CorotationalKernels& corotational();

/// Additions, subtractions, multiplications and divisions since the last call. A fused multiply-add is two.
long take_count();

}  // namespace plica::counted
