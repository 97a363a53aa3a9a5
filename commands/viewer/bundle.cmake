# cmake -DNPM= -DNODE= -DSOURCE= -DFOLDER= -DPAGE= -DTESTS= -P bundle.cmake: installs the packages of the lock file in FOLDER, makes PAGE.
# What goes wrong is said, and fails no build.
function(without_page reason)
  file(REMOVE "${PAGE}")
  message(NOTICE "lacon report will not work: ${reason}. Everything else does; build again once npm reaches its registry.")
endfunction()

file(COPY "${SOURCE}/package.json" "${SOURCE}/package-lock.json" "${SOURCE}/.npmrc" "${SOURCE}/build.mjs" "${SOURCE}/src" DESTINATION "${FOLDER}")
file(SHA256 "${SOURCE}/package-lock.json" lock)
set(stamp "${FOLDER}/node_modules/.installed")
set(installed "")
if(EXISTS "${stamp}")
  file(READ "${stamp}" installed)
endif()
if(NOT installed STREQUAL "${lock} ${TESTS}")
  set(omit "")
  if(NOT TESTS)
    set(omit --omit=dev)  # what drives the browser
  endif()
  execute_process(COMMAND "${NPM}" ci --fetch-retries=1 --fetch-retry-mintimeout=1000 --fetch-retry-maxtimeout=5000 --fetch-timeout=30000 --loglevel=error ${omit}
    WORKING_DIRECTORY "${FOLDER}" TIMEOUT 240 RESULT_VARIABLE status OUTPUT_QUIET ERROR_VARIABLE said)
  if(NOT status EQUAL 0)
    string(REGEX REPLACE "\n.*" "" why "${said}")  # "npm error code EAI_AGAIN"
    without_page("npm cannot install its packages (${why})")
    return()
  endif()
  file(WRITE "${stamp}" "${lock} ${TESTS}")
endif()
execute_process(COMMAND "${NODE}" build.mjs "${PAGE}" WORKING_DIRECTORY "${FOLDER}" TIMEOUT 120 RESULT_VARIABLE status ERROR_VARIABLE said)
if(NOT status EQUAL 0)
  message(NOTICE "${said}")
  without_page("its page cannot be bundled")
endif()
