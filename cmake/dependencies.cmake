# SPDX-License-Identifier: Apache-2.0
# Libraries, all from Debian 12. docs/ARCHITECTURE.md says what each is for.
find_package(OpenMP REQUIRED)
find_package(Eigen3 3.4 REQUIRED)
# Its sums go by the width of the registers; they are few and small here, and the bits are to be the same for every width.
target_compile_definitions(Eigen3::Eigen INTERFACE EIGEN_DONT_VECTORIZE)
find_package(yaml-cpp REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(CLI11 REQUIRED)
find_package(spdlog REQUIRED)
find_package(fmt REQUIRED)
find_package(ZLIB REQUIRED)
find_package(HDF5 REQUIRED COMPONENTS C)
find_package(VTK REQUIRED COMPONENTS CommonCore CommonDataModel CommonExecutionModel FiltersCore IOXML IOLegacy)
# Debian keeps OpenVDB's own module out of CMake's path.
list(APPEND CMAKE_MODULE_PATH /usr/lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB)
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)
