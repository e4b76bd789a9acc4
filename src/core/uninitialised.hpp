// Vectors with uninitialised new elements, for large arrays that several threads fill right after allocation. Zeroing
// would pass through their memory once more on one thread.
#pragma once

#include <memory>
#include <utility>
#include <vector>

namespace plica {

template <class T>
struct UninitialisedAllocator : std::allocator<T> {
  template <class U>
  struct rebind {
    using other = UninitialisedAllocator<U>;
  };
  template <class U>
  void construct(U* place) {
    ::new (static_cast<void*>(place)) U;
  }
  template <class U, class... Arguments>
  void construct(U* place, Arguments&&... arguments) {
    ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
  }
};

/// Vector whose resize() and sized constructor leave numbers unset.
template <class T>
using UninitialisedVector = std::vector<T, UninitialisedAllocator<T>>;

}  // namespace plica
