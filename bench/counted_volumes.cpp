#include "counted_lanes.hpp"
// After that, which decides what they are made of:
#include "counted_kernels.hpp"
#include "mechanics/kernels/volume_kernels.cpp"

namespace plica::counted {

const VolumeKernels& volumes() { return volume_kernels; }

}  // namespace plica::counted
