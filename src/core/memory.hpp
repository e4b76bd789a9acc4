// Room in memory, asked for ahead of libraries that cannot bear to be refused it.
#pragma once

#include <cstddef>

namespace plica {

/// std::bad_alloc when there is no room for so many bytes now. Takes none of it.
void make_sure_of_memory(std::size_t bytes);

}  // namespace plica
