// Choice of kernels. Kernel sources (*_kernels.cpp) are compiled for several instruction sets; laws choose one when
// they are made.
#pragma once

#include <string_view>
#include <vector>

namespace plica {

/// Instruction sets with kernels. Results of generic and other sets differ by rounding (after each product, or after
/// each product and sum); each set is bitwise reproducible.
enum class Kernels { generic, avx2, avx512 };

[[nodiscard]] std::string_view name(Kernels kernels);

/// Return the sets that this program has and this machine supports, slowest first.
[[nodiscard]] const std::vector<Kernels>& available_kernels();

/// Select one of three kernel tables by instruction set.
template <class Table>
const Table& kernels_for(Kernels kernels, const Table& generic, const Table& avx2, const Table& avx512) {
  return kernels == Kernels::avx512 ? avx512 : kernels == Kernels::avx2 ? avx2 : generic;
}

/// Return the fastest set, or the one named by the environment variable PLICA_KERNELS. Throws std::invalid_argument if
/// that is unavailable.
[[nodiscard]] Kernels chosen_kernels();

}  // namespace plica
