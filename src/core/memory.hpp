// Room in memory: asked for ahead of libraries that cannot bear to be refused it, and kept for the next who needs it.
#pragma once

#include <cstddef>

namespace plica {

/// std::bad_alloc when there is no room for so many bytes now. Takes none of it.
void make_sure_of_memory(std::size_t bytes);

/// From now on the C library (glibc) keeps freed memory of any size instead of giving it back to the system, which
/// would clear it each time it is asked for again: for programs that take and free the same large arrays all the time.
/// To be called at the start of a program.
void keep_freed_memory();

/// The same up to some 100 MB, for a module in somebody else's program.
void keep_some_freed_memory();

/// The most memory that this process has had at once, MB (1e6 bytes).
double peak_memory_MB();

}  // namespace plica
