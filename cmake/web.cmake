# SPDX-License-Identifier: Apache-2.0
# The report's page: web/ bundled by esbuild into build/.../web, from where report/ embeds it. npm brings what is bundled, in the
# versions of web/package-lock.json; without its registry there is no page, and so no build.
find_program(NPM npm)
find_program(NODE NAMES node nodejs)
if(NOT NPM OR NOT NODE)
  message(FATAL_ERROR "The report's page is built with Node.js 18 or newer and npm, which are not here. Install the packages nodejs and npm "
                      "(./run build does).")
endif()
set(PATENCY_WEB ${CMAKE_SOURCE_DIR}/web)
set(PATENCY_PAGE ${CMAKE_BINARY_DIR}/web)
set(page_modules ${PATENCY_WEB}/node_modules/.package-lock.json)   # npm writes it last
set(page_parts page.js page.js.hash style.css style.css.hash)
list(TRANSFORM page_parts PREPEND ${PATENCY_PAGE}/)
file(GLOB page_sources CONFIGURE_DEPENDS ${PATENCY_WEB}/src/*)
add_custom_command(OUTPUT ${page_modules}
  COMMAND ${CMAKE_COMMAND} -DNPM=${NPM} -DFOLDER=${PATENCY_WEB} -P ${CMAKE_SOURCE_DIR}/cmake/install_modules.cmake
  DEPENDS ${PATENCY_WEB}/package.json ${PATENCY_WEB}/package-lock.json ${PATENCY_WEB}/.npmrc
  COMMENT "Installing what the report's page is made of")
add_custom_command(OUTPUT ${page_parts}
  COMMAND ${NODE} ${PATENCY_WEB}/build.mjs ${PATENCY_PAGE}
  DEPENDS ${page_modules} ${PATENCY_WEB}/build.mjs ${page_sources}
  COMMENT "Bundling the report's page")
add_custom_target(patency_page DEPENDS ${page_parts})
