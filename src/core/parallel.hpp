// Loops over threads whose results do not depend on how many there are: every iteration writes only what is its own,
// and sums are taken afterwards in a fixed order.
#pragma once

#include <cstddef>

namespace plica {

/// Calls body(i) for i in [0, count). Iterations must not write to the same place.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
#pragma omp parallel for schedule(static)
  for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace plica
