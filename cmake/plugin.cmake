# lacon_plugin(name SOURCES ... ROWS plugin.toml LINK ...): a plug-in, that is a folder <name>/ with lib<name>.so and its plugin.toml.
# Used here for the built-in plug-ins and, through find_package(lacon), by plug-ins outside the tree.
function(lacon_plugin name)
  cmake_parse_arguments(PLUGIN "" "ROWS" "SOURCES;LINK" ${ARGN})
  set(folder "${PROJECT_BINARY_DIR}/lib/lacon/plugins/${name}")
  add_library(plugin_${name} MODULE ${PLUGIN_SOURCES})
  target_link_libraries(plugin_${name} PRIVATE lacon::plugin ${PLUGIN_LINK})
  set_target_properties(plugin_${name} PROPERTIES OUTPUT_NAME ${name} PREFIX lib SUFFIX .so
    CXX_VISIBILITY_PRESET hidden C_VISIBILITY_PRESET hidden LIBRARY_OUTPUT_DIRECTORY "${folder}")
  install(TARGETS plugin_${name} LIBRARY DESTINATION "lib/lacon/plugins/${name}")
  if(PLUGIN_ROWS)
    configure_file("${PLUGIN_ROWS}" "${folder}/plugin.toml" COPYONLY)
    install(FILES "${PLUGIN_ROWS}" DESTINATION "lib/lacon/plugins/${name}" RENAME plugin.toml)
  endif()
endfunction()
