// Kernels of src/mechanics/kernels/ compiled with counting numbers, to count their floating-point operations.
#pragma once

#include "mechanics/kernels/tables.hpp"

namespace plica::counted {

const CorotationalKernels& corotational();
const VolumeKernels& volumes();

/// Operations of both kernels since the last call on this thread; a fused multiply-add counts as two.
long take_count();

}  // namespace plica::counted
