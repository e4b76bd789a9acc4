// Reading of what a library might not survive, first in a process of its own.
#pragma once

#include <cstddef>
#include <functional>

namespace plica {

/// Calls `read` in a copy of this process. Its FileError and bad_alloc come out here; a FileError, too, when it crashes
/// or takes far longer than reading `bytes` can: HDF5 trusts what is in a file, and a few damaged bytes, under a
/// checksum that was made for them, send it round in circles.
void read_on_trial(const std::function<void()>& read, std::size_t bytes);

}  // namespace plica
