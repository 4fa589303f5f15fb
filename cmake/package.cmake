# Install rules: libraries, headers, the program, and a package that find_package(stereovox) finds.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(stages GLOBAL PROPERTY STEREOVOX_STAGES)
install(TARGETS ${stages} stereovox_options EXPORT stereovoxTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS stereovox_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY src/stereovox DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/stereovox)
install(EXPORT stereovoxTargets NAMESPACE stereovox:: DESTINATION ${package_dir})
configure_package_config_file(cmake/stereovoxConfig.cmake.in stereovoxConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(stereovoxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/stereovoxConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/stereovoxConfigVersion.cmake DESTINATION ${package_dir})
