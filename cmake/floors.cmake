# SPDX-License-Identifier: Apache-2.0
# One static library per folder of src/patency, in the order of floors.txt, each linked only against those
# before it (docs/ARCHITECTURE.md). tools/check_layers checks the same order on the includes.
set(PATENCY_FLOORS)
file(STRINGS ${CMAKE_SOURCE_DIR}/src/patency/floors.txt folders REGEX "^[a-z]")
list(TRANSFORM folders REPLACE " +" ";")
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/patency/floors.txt)
# Linked last to first, so that a folder sees those before it.
foreach(folder ${folders})
  set(PATENCY_BELOW_${folder} ${PATENCY_FLOORS})   # what the tests of a folder without sources need
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/src/patency/${folder}/*.cpp)
  if(NOT sources)
    continue()
  endif()
  add_library(patency_${folder} STATIC ${sources})
  target_link_libraries(patency_${folder} PRIVATE patency_flags PUBLIC ${PATENCY_FLOORS} OpenMP::OpenMP_CXX fmt::fmt)
  patency_compile(patency_${folder} ${folder})
  patency_compile_together(patency_${folder} ${folder})
  list(PREPEND PATENCY_FLOORS patency_${folder})
endforeach()

function(patency_use folder)   # a folder's own libraries
  if(TARGET patency_${folder})
    target_link_libraries(patency_${folder} PRIVATE ${ARGN})
  endif()
endfunction()
patency_use(config yaml-cpp nlohmann_json::nlohmann_json)
patency_use(physics Eigen3::Eigen)
patency_use(shape Eigen3::Eigen OpenVDB::openvdb VTK::FiltersCore VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel)
patency_use(schemes Eigen3::Eigen)
patency_use(analysis Eigen3::Eigen)
patency_use(io nlohmann_json::nlohmann_json spdlog::spdlog ZLIB::ZLIB hdf5::hdf5 VTK::IOXML VTK::IOLegacy VTK::CommonCore VTK::CommonDataModel VTK::CommonExecutionModel)
patency_use(stages nlohmann_json::nlohmann_json)
patency_use(report nlohmann_json::nlohmann_json)
patency_use(verify nlohmann_json::nlohmann_json)

# The page is embedded in the program by report/page_parts.cpp.
add_dependencies(patency_report patency_page)
set_source_files_properties(${CMAKE_SOURCE_DIR}/src/patency/report/page_parts.cpp PROPERTIES
  COMPILE_DEFINITIONS PATENCY_PAGE="${PATENCY_PAGE}" OBJECT_DEPENDS "${page_parts}")
