#include "core/memory.hpp"

#include <sys/resource.h>

#include <cstdlib>
#include <new>
#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace plica {

void make_sure_of_memory(std::size_t bytes) {
  void* volatile block = std::malloc(bytes);  // volatile: the compiler must not remove it
  if (block == nullptr) throw std::bad_alloc();
  std::free(block);
}

void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 0);         // no separate pages for large arrays
  mallopt(M_TRIM_THRESHOLD, -1);  // never given back
#endif
}

void keep_some_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 128 << 20);
#endif
}

double peak_memory_MB() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024e-6;  // kB of 1024 bytes, on Linux
}

}  // namespace plica
