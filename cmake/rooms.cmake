# A room is one static library, lacon::<name>, whose headers are included as "lacon/<name>/<header>.hpp".
include(GNUInstallDirs)

# the source tree seen as include/lacon/
file(MAKE_DIRECTORY "${PROJECT_BINARY_DIR}/include")
file(CREATE_LINK "${PROJECT_SOURCE_DIR}" "${PROJECT_BINARY_DIR}/include/lacon" SYMBOLIC)

# lacon_room(name SOURCES ... PUBLIC other rooms and libraries PRIVATE libraries)
function(lacon_room name)
  cmake_parse_arguments(ROOM "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(lacon_${name} STATIC ${ROOM_SOURCES})
  add_library(lacon::${name} ALIAS lacon_${name})
  set_target_properties(lacon_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(lacon_${name} PUBLIC
    "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>"
    "$<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/generated>"
    "$<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>")
  target_compile_features(lacon_${name} PUBLIC cxx_std_20)
  target_link_libraries(lacon_${name} PUBLIC ${ROOM_PUBLIC} PRIVATE ${ROOM_PRIVATE})
  install(TARGETS lacon_${name} EXPORT lacon ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(DIRECTORY . DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/lacon/${name}" FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h")
endfunction()

# lacon_operator(name SOURCES ... LINK ...): the executable of a command
function(lacon_operator name)
  cmake_parse_arguments(OPERATOR "" "" "SOURCES;LINK" ${ARGN})
  add_executable(${name} ${OPERATOR_SOURCES})
  target_link_libraries(${name} PRIVATE ${OPERATOR_LINK} lacon::program)
  target_link_options(${name} PRIVATE -Wl,--as-needed)  # an operator that does not solve does not load MUMPS
  install(TARGETS ${name} RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}")
endfunction()
