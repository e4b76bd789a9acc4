// Entry point of libFuzzer, compiled once per target.
#include <sanitizer/common_interface_defs.h>
#include <unistd.h>

#include <csignal>
#include <cstddef>
#include <cstdint>

#include "scenario/setup.hpp"
#include "targets.hpp"

// Whether a mesh is closed takes the tissue itself, which is not fuzzed here.
void plica::set_default_shell(Scenario&) {}

/// Report the position of a child process at its time limit.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
  std::signal(SIGXCPU, [](int) {
    __sanitizer_print_stack_trace();
    ::_exit(1);
  });
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  plica::PLICA_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
