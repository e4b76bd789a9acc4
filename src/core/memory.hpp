// Memory: checks ahead of libraries that do not survive a failed allocation, and reuse of freed memory.
#pragma once

#include <cstddef>

namespace plica {

/// Throw std::bad_alloc if `bytes` cannot be allocated now. Allocates nothing.
void make_sure_of_memory(std::size_t bytes);

/// Make the C library (glibc) keep freed memory of any size instead of returning it to the system, which would clear it
/// at each reallocation. Speeds up repeated allocation of large arrays. Call at the start of a program.
void keep_freed_memory();

/// Keep freed memory up to about 100 MB; for a module within another program.
void keep_some_freed_memory();

/// Peak memory of this process, MB (1e6 bytes).
double peak_memory_MB();

}  // namespace plica
