# SPDX-License-Identifier: Apache-2.0
# cmake --install: the program, its manual page and bash completion (it prints both), decks and documents.
include(GNUInstallDirs)
set(patency_printed ${CMAKE_BINARY_DIR}/patency.1 ${CMAKE_BINARY_DIR}/patency.bash)
add_custom_command(OUTPUT ${patency_printed}
  COMMAND patency man > patency.1
  COMMAND patency completion bash > patency.bash
  WORKING_DIRECTORY ${CMAKE_BINARY_DIR} DEPENDS patency VERBATIM
  COMMENT "Printing the manual page and the completion")
add_custom_target(patency_documents ALL DEPENDS ${patency_printed})
install(TARGETS patency RUNTIME)
install(FILES ${CMAKE_BINARY_DIR}/patency.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
install(FILES ${CMAKE_BINARY_DIR}/patency.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME patency)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/patency)
install(DIRECTORY docs/ DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
