# SPDX-License-Identifier: Apache-2.0
# npm ci in FOLDER; says in a sentence what is wrong when it fails.
execute_process(COMMAND ${NPM} ci --ignore-scripts --no-audit --no-fund WORKING_DIRECTORY ${FOLDER}
  RESULT_VARIABLE code OUTPUT_VARIABLE said ERROR_VARIABLE said)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "npm could not install the modules of ${FOLDER}/package-lock.json, which the report's page is made of. "
                      "Is there a network, and does `npm ping` reach a registry? Nothing is built without the page. npm said:\n${said}")
endif()
file(TOUCH ${FOLDER}/node_modules/.package-lock.json)
