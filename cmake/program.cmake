# SPDX-License-Identifier: Apache-2.0
# The program. A package holds it once for every instruction set, as patency-SET in a folder of its own, and as `patency` a small
# program that becomes the one for the processor (app/chooser).
include(GNUInstallDirs)
set(PATENCY_PROGRAM patency)
set(PATENCY_PROGRAM_FOLDER ${CMAKE_INSTALL_BINDIR})
set(developers_tree ${CMAKE_SOURCE_DIR})   # where a developer's build finds the decks of verification
if(PATENCY_PACKAGE)
  set(PATENCY_PROGRAM patency-${PATENCY_ISA})
  set(PATENCY_PROGRAM_FOLDER ${CMAKE_INSTALL_LIBEXECDIR}/patency)
  set(developers_tree .)
endif()

file(GLOB app_sources CONFIGURE_DEPENDS app/*.cpp)
add_executable(patency ${app_sources})
target_link_libraries(patency PRIVATE patency_flags ${PATENCY_FLOORS} CLI11::CLI11 spdlog::spdlog)
file(RELATIVE_PATH data /${PATENCY_PROGRAM_FOLDER} /${CMAKE_INSTALL_DATADIR}/patency)   # from where the program is installed
target_compile_definitions(patency PRIVATE PATENCY_VERSION="${PROJECT_VERSION}" PATENCY_ISA="${PATENCY_ISA}"
  PATENCY_DATA="${data}" PATENCY_SOURCE_DIR="${developers_tree}")
patency_compile(patency app)
patency_compile_together(patency app)
set_target_properties(patency PROPERTIES OUTPUT_NAME ${PATENCY_PROGRAM} RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

file(GLOB chooser_sources CONFIGURE_DEPENDS app/chooser/*.cpp)
add_executable(patency_chooser ${chooser_sources})
target_link_libraries(patency_chooser PRIVATE patency_flags)
file(RELATIVE_PATH programs /${CMAKE_INSTALL_BINDIR} /${CMAKE_INSTALL_LIBEXECDIR}/patency)
target_compile_definitions(patency_chooser PRIVATE PATENCY_PROGRAMS="${programs}")
set_target_properties(patency_chooser PROPERTIES OUTPUT_NAME patency RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR}/chooser)
