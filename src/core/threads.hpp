// How many threads suit a tissue.
#pragma once

#include <cstddef>

namespace plica {

/// `asked`, if over 0; else what OMP_NUM_THREADS says; else one for every 10 000 elements, up to what the machine has.
int threads_for(int asked, std::size_t elements);

}  // namespace plica
