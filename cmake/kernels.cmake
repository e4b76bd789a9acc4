# Compiles kernel sources once per instruction set into plica_core; the program chooses at start
# (src/mechanics/kernels/kernels.hpp). They may use fused multiply-add. Every build optimises them, so that a debug build is
# fast where it matters; with sanitizers less, because that would take minutes per file.
set(kernel_optimisation -O3)
if(PLICA_SANITIZE)
  set(kernel_optimisation -O1)
endif()
function(add_kernels name lanes)
  add_library(plica_kernels_${name} OBJECT ${kernel_sources})
  target_link_libraries(plica_kernels_${name} PRIVATE plica_options)
  target_compile_definitions(plica_kernels_${name} PRIVATE PLICA_KERNELS=${name} PLICA_LANES=${lanes})
  target_compile_options(plica_kernels_${name} PRIVATE ${kernel_optimisation} ${ARGN})
  target_sources(plica_core PRIVATE $<TARGET_OBJECTS:plica_kernels_${name}>)
endfunction()

set_source_files_properties(${kernel_sources} PROPERTIES COMPILE_OPTIONS -ffp-contract=fast)  # after plica_options'
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  add_kernels(generic 2)
  add_kernels(avx2 4 -mavx2 -mfma)
  # Tuned for the first processors with AVX-512, which is 5 % faster on Zen 4 too (docs/decisions/0015-speed.md).
  # GCC 12 warns of a vector that its own header leaves undefined on purpose.
  add_kernels(avx512 8 -mavx512f -mavx512dq -mavx512vl -mfma -mprefer-vector-width=512 -mtune=skylake-avx512
              "$<$<CXX_COMPILER_ID:GNU>:-Wno-uninitialized;-Wno-maybe-uninitialized>")
else()
  add_kernels(generic 2)
  add_kernels(avx2 2)  # exists, but is never chosen
  add_kernels(avx512 2)
endif()
