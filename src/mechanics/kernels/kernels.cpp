#include "mechanics/kernels/kernels.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace plica {

std::string_view name(Kernels kernels) {
  switch (kernels) {
    case Kernels::avx2:
      return "avx2";
    case Kernels::avx512:
      return "avx512";
    default:
      return "generic";
  }
}

const std::vector<Kernels>& available_kernels() {
  static const std::vector<Kernels> available = [] {
    std::vector<Kernels> kernels = {Kernels::generic};
#ifdef __x86_64__
    const bool fma = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
    if (fma) kernels.push_back(Kernels::avx2);
    if (fma && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512vl"))
      kernels.push_back(Kernels::avx512);
#endif
    return kernels;
  }();
  return available;
}

Kernels chosen_kernels() {
  const char* wanted = std::getenv("PLICA_KERNELS");
  if (!wanted || !*wanted) return available_kernels().back();
  std::string known;
  for (const Kernels kernels : available_kernels()) {
    if (name(kernels) == wanted) return kernels;
    known += (known.empty() ? "" : ", ") + std::string(name(kernels));
  }
  throw std::invalid_argument("PLICA_KERNELS=" + std::string(wanted) + ": this machine has " + known);
}

}  // namespace plica
