// Loops over threads whose results do not depend on how many there are: every iteration writes only what is its own,
// and sums are taken afterwards in a fixed order.
#pragma once

#include <cstddef>

namespace plica {

/// Calls body(i) for i in [0, count). Iterations must not write to the same place. Short loops stay on one thread:
/// waking the others costs more than they save.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  constexpr std::size_t worth_sharing = 256;
#pragma omp parallel for schedule(static) if (count >= worth_sharing)
  for (std::size_t i = 0; i < count; ++i) body(i);
}

}  // namespace plica
