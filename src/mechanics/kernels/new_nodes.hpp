// Which nodes memory should be asked for ahead. For kernels too: a plain array.
#pragma once

namespace plica {

/// The nodes that a batch has and the batches shortly before it do not, which kernels have not touched for long: three
/// times their numbers, increasing, the last one repeated. Of more than there is room for, some; of none, one it has.
using NewNodes = int[16];

}  // namespace plica
