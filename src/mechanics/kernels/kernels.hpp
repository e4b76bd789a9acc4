// Kernel sources (*_kernels.cpp) are compiled for several instruction sets; the one to use is chosen when laws are
// made.
#pragma once

#include <string_view>
#include <vector>

namespace plica {

/// Instruction sets that there are kernels for. Their results differ by rounding (generic ones round after each
/// product, the others after each product and sum); each gives the same bits every time.
enum class Kernels { generic, avx2, avx512 };

[[nodiscard]] std::string_view name(Kernels kernels);

/// Those that this program has and this machine runs, slowest first.
[[nodiscard]] const std::vector<Kernels>& available_kernels();

/// The one of three tables of kernels that is for an instruction set.
template <class Table>
const Table& kernels_for(Kernels kernels, const Table& generic, const Table& avx2, const Table& avx512) {
  return kernels == Kernels::avx512 ? avx512 : kernels == Kernels::avx2 ? avx2 : generic;
}

/// The last of them, or the one that the environment variable PLICA_KERNELS names. Throws std::invalid_argument when
/// that is not available.
[[nodiscard]] Kernels chosen_kernels();

}  // namespace plica
