# SPDX-License-Identifier: Apache-2.0
# cmake --install: the program, its manual page and the completions (it prints them), decks and documents. Of a package's three builds,
# the one that any processor can run brings what they share.
install(TARGETS patency RUNTIME DESTINATION ${PATENCY_PROGRAM_FOLDER})
if(PATENCY_PACKAGE AND NOT PATENCY_ISA STREQUAL "baseline")
  return()
endif()
set(patency_printed ${CMAKE_BINARY_DIR}/patency.1.gz ${CMAKE_BINARY_DIR}/patency.bash ${CMAKE_BINARY_DIR}/patency.zsh)
add_custom_command(OUTPUT ${patency_printed}
  COMMAND patency man > patency.1
  COMMAND gzip -9nf patency.1
  COMMAND patency completion bash > patency.bash
  COMMAND patency completion zsh > patency.zsh
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR} DEPENDS patency VERBATIM
  COMMENT "Printing the manual page and the completions")
add_custom_target(patency_documents ALL DEPENDS ${patency_printed})
install(FILES ${CMAKE_BINARY_DIR}/patency.1.gz DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${CMAKE_BINARY_DIR}/patency.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME patency)
install(FILES ${CMAKE_BINARY_DIR}/patency.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _patency)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/patency)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
if(NOT PATENCY_PACKAGE)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
  return()
endif()
install(TARGETS patency_chooser RUNTIME)
include(cmake/package.cmake)
