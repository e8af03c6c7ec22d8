# Builds each *.simd.cpp once per instruction set, each time in its own namespace RINGLET_SIMD (baseline, avx2, avx512), so that a
# portable wheel picks the widest at run time (math/simd.h). These files include nothing with inline functions of its own
# (no Eigen): the linker keeps one copy of those, and it might be one that the processor cannot run.
include(CheckCXXCompilerFlag)

set(simd_baseline_flags "")
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(simd_sets baseline avx2 avx512)
  set(simd_avx2_flags -mavx2 -mfma)
  set(simd_avx512_flags -mavx512f -mavx512dq -mavx512vl -mavx512bw -mfma -mprefer-vector-width=512)
else()
  set(simd_sets baseline)
endif()

function(ringlet_simd_sources target)
  foreach(set IN LISTS simd_sets)
    add_library(${target}_${set} OBJECT ${ARGN})
    target_include_directories(${target}_${set} PRIVATE $<TARGET_PROPERTY:${target},INCLUDE_DIRECTORIES>)
    target_compile_definitions(${target}_${set} PRIVATE RINGLET_SIMD=${set} RINGLET_SIMD_${set}=1)
    target_compile_options(${target}_${set} PRIVATE ${simd_${set}_flags} -O3 -fno-math-errno -fno-trapping-math
      -Wall -Wextra $<$<CXX_COMPILER_ID:GNU>:-Wno-psabi>)
    target_link_libraries(${target}_${set} PRIVATE OpenMP::OpenMP_CXX)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_${set}>)
  endforeach()
  list(LENGTH simd_sets count)
  if(count GREATER 1)
    target_compile_definitions(${target} PUBLIC RINGLET_SIMD_X86=1)
  endif()
endfunction()
