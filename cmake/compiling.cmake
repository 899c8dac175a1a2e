# SPDX-License-Identifier: Apache-2.0
# How a folder is compiled. Loops over particles and voxels are compiled for speed; folders that read, write and arrange are compiled
# quickly (-O1), for that is half of their building time. Either way has its precompiled header.
set(PATENCY_ARRANGING config io stages report verify app)
foreach(way looping arranging)
  set(empty ${CMAKE_BINARY_DIR}/precompiled_${way}.cpp)
  file(CONFIGURE OUTPUT ${empty} CONTENT "// holds the precompiled header\n")
  add_library(patency_precompiled_${way} OBJECT ${empty})
  target_link_libraries(patency_precompiled_${way} PRIVATE patency_flags OpenMP::OpenMP_CXX)
  target_precompile_headers(patency_precompiled_${way} PRIVATE ${CMAKE_SOURCE_DIR}/cmake/precompiled.h)
endforeach()
target_compile_options(patency_precompiled_arranging PRIVATE $<$<CONFIG:Release>:-O1>)

function(patency_compile target folder)
  set(way looping)
  if(folder IN_LIST PATENCY_ARRANGING)
    set(way arranging)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_precompile_headers(${target} REUSE_FROM patency_precompiled_${way})
endfunction()

# What takes longest in folders that arrange is to read and instantiate the same libraries anew in every file: several are read
# at once. Not in the debug preset, which therefore sees what a file forgets to include.
option(PATENCY_TOGETHER "Compile several files of a folder at once where that is quicker" ON)
function(patency_compile_together target folder)
  if(PATENCY_TOGETHER AND folder MATCHES "^(io|stages|report|verify|app)$")
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 8)
  endif()
endfunction()
set(alone io/surface_picture report/curve verify/vessel_sections)   # whose own names are others' too
list(TRANSFORM alone REPLACE "(.+)" "${CMAKE_SOURCE_DIR}/src/patency/\\1.cpp")
set_source_files_properties(${alone} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)

# Its reference loops are timed.
file(GLOB timed CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/patency/verify/bench_*.cpp)
set_source_files_properties(${timed} PROPERTIES COMPILE_OPTIONS $<$<CONFIG:Release>:-O3> SKIP_PRECOMPILE_HEADERS ON)

# What runs of OpenVDB is in its library, compiled: its headers are read quickly.
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/patency/shape/surface_voxels.cpp PROPERTIES
  COMPILE_OPTIONS $<$<CONFIG:Release>:-O1> SKIP_PRECOMPILE_HEADERS ON)
