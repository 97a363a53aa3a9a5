# lacon_gtest_suites(name PROPERTIES ...): each suite of the executable unit_<name> is a test of ctest, unit/<name>/<suite>. Each case of a
# suite by itself would be three thousand tests, which take ten times as long to start as to run.

function(lacon_gtest_suites name)
  cmake_parse_arguments(SUITES "" "" "PROPERTIES" ${ARGN})
  set(suites "${CMAKE_CURRENT_BINARY_DIR}/unit_${name}_suites.cmake")
  set(all "${CMAKE_CURRENT_BINARY_DIR}/unit_${name}_tests.cmake")
  set_property(TARGET unit_${name} APPEND PROPERTY LINK_DEPENDS "${CMAKE_CURRENT_FUNCTION_LIST_FILE}")
  add_custom_command(TARGET unit_${name} POST_BUILD VERBATIM BYPRODUCTS "${suites}"
    COMMAND "${CMAKE_COMMAND}" "-Dexecutable=$<TARGET_FILE:unit_${name}>" "-Dprefix=unit/${name}/" "-Dproperties=${SUITES_PROPERTIES}"
            "-Dsuites=${suites}" -P "${CMAKE_CURRENT_FUNCTION_LIST_FILE}")
  file(WRITE "${all}" "if(EXISTS \"${suites}\")\n  include(\"${suites}\")\nelse()\n  add_test(unit/${name}/not_built unit_${name}_is_not_built)\nendif()\n")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES "${all}")
endfunction()

# What follows runs after the executable is linked.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  return()
endif()
execute_process(COMMAND "${executable}" --gtest_list_tests OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "(^|\n)[^ \n]+\\." found "${listed}")
string(REPLACE ";" " " properties "${properties}")
set(script "")
foreach(suite IN LISTS found)
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" suite "${suite}")
  set(test "[==[${prefix}${suite}]==]")
  string(APPEND script "add_test(${test} [==[${executable}]==] [==[--gtest_filter=${suite}.*]==])\n")
  string(APPEND script "set_tests_properties(${test} PROPERTIES SKIP_RETURN_CODE 77 ${properties})\n")
endforeach()
file(WRITE "${suites}" "${script}")
