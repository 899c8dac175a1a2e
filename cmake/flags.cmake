# SPDX-License-Identifier: Apache-2.0
# One set of flags for everything.
#   -ffp-contract=off    a*b+c is fused only where the source says fma(): the same bits for every vector width
#   -fno-math-errno      sqrt() becomes one instruction
#   -fno-trapping-math   lets the compiler turn lane loops into vector instructions
# Not -ffast-math and not -ffinite-math-only: NaN checks must work and sums must keep their order.
# Where a processor can fuse, g++ 12 does so in spite of -ffp-contract=off when it puts straight code side by side: c x - s y beside
# c y + s x (tools/check_fusion). With AVX-512 it also stored the four numbers {1, 1, 1, 0} as four ones (PageData's test sees it). Packs do
# without that, for they name their instructions (base/pack.h).
set(unfused -fno-tree-slp-vectorize)
set(PATENCY_ARCH_native -march=native ${unfused})
set(PATENCY_ARCH_avx512 -march=x86-64-v4 ${unfused})
set(PATENCY_ARCH_avx2 -march=x86-64-v3 ${unfused})
set(PATENCY_ARCH_baseline -march=x86-64)
set(PATENCY_ARCH ${PATENCY_ARCH_${PATENCY_ISA}})

add_library(patency_flags INTERFACE)
target_include_directories(patency_flags INTERFACE ${CMAKE_SOURCE_DIR}/src)
target_compile_options(patency_flags INTERFACE
  -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
  $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>   # g++ 12 warns inside its own AVX-512 headers
  -ffp-contract=off -fno-math-errno -fno-trapping-math ${PATENCY_ARCH})
if(PATENCY_ISA MATCHES "native|avx512")
  target_compile_options(patency_flags INTERFACE -mprefer-vector-width=512)
endif()
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_CXX_FLAGS_DEBUG "-O1 -g")
if(PATENCY_SANITIZE)
  target_compile_options(patency_flags INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(patency_flags INTERFACE -fsanitize=address,undefined)
endif()
if(PATENCY_FUZZ)   # all that it is to see
  target_compile_options(patency_flags INTERFACE -fsanitize=fuzzer-no-link,address -fno-omit-frame-pointer)
  target_link_options(patency_flags INTERFACE -fsanitize=address)
endif()
