#include "core/threads.hpp"

#include <omp.h>

#include <algorithm>
#include <cstdlib>

namespace plica {

int threads_for(int asked, std::size_t elements) {
  if (asked > 0) return asked;
  if (std::getenv("OMP_NUM_THREADS") != nullptr) return omp_get_max_threads();
  constexpr std::size_t elements_a_thread = 5000;
  return static_cast<int>(std::min<std::size_t>(omp_get_num_procs(), 1 + elements / elements_a_thread));
}

}  // namespace plica
