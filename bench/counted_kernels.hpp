// The kernels of src/mechanics/kernels/ once more, with numbers that count: how many floating-point operations they
// take.
#pragma once

#include "mechanics/kernels/corotational_kernels.hpp"
#include "mechanics/kernels/volume_kernels.hpp"

namespace plica::counted {

const CorotationalKernels& corotational();
const VolumeKernels& volumes();

/// Operations of the two's kernels since the last call, by this thread. A fused multiply-add is two.
long take_count();

}  // namespace plica::counted
