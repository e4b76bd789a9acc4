#include "core/memory.hpp"

#include <cstdlib>
#include <new>

namespace plica {

void make_sure_of_memory(std::size_t bytes) {
  void* volatile block = std::malloc(bytes);  // volatile: else the compiler leaves out what is not used
  if (block == nullptr) throw std::bad_alloc();
  std::free(block);
}

}  // namespace plica
