# The package that a plug-in outside the tree builds against: find_package(lacon).
include(CMakePackageConfigHelpers)
install(EXPORT lacon NAMESPACE lacon:: DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lacon")
configure_package_config_file(cmake/laconConfig.cmake.in "${PROJECT_BINARY_DIR}/laconConfig.cmake"
  INSTALL_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lacon")
write_basic_package_version_file("${PROJECT_BINARY_DIR}/laconConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/laconConfig.cmake" "${PROJECT_BINARY_DIR}/laconConfigVersion.cmake" cmake/plugin.cmake cmake/hdf5.cmake
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lacon")
install(DIRECTORY "${PROJECT_BINARY_DIR}/generated/lacon/" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/lacon" FILES_MATCHING PATTERN "*.hpp")
install(DIRECTORY catalog/ DESTINATION "${CMAKE_INSTALL_DATADIR}/lacon/catalog" FILES_MATCHING PATTERN "*.toml")
install(FILES "${PROJECT_BINARY_DIR}/generated/catalog.json" DESTINATION "${CMAKE_INSTALL_DATADIR}/lacon")
install(FILES LICENSE README.md DESTINATION "${CMAKE_INSTALL_DOCDIR}")
