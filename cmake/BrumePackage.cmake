# What lets a stranger write find_package(Brume 0.1 COMPONENTS Mappers).

include(CMakePackageConfigHelpers)
set(brume_cmake_dir "${CMAKE_INSTALL_LIBDIR}/cmake/Brume")
configure_package_config_file(
  "${PROJECT_SOURCE_DIR}/cmake/BrumeConfig.cmake.in"
  "${PROJECT_BINARY_DIR}/${brume_cmake_dir}/BrumeConfig.cmake"
  INSTALL_DESTINATION "${brume_cmake_dir}")
write_basic_package_version_file(
  "${PROJECT_BINARY_DIR}/${brume_cmake_dir}/BrumeConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/${brume_cmake_dir}/BrumeConfig.cmake"
  "${PROJECT_BINARY_DIR}/${brume_cmake_dir}/BrumeConfigVersion.cmake"
  DESTINATION "${brume_cmake_dir}")
