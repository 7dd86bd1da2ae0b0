# What lets a stranger write find_package(Brume 0.1 COMPONENTS Mappers).

# The modules of VTK that the exported targets name: all that Brume's modules depend on.
set(brume_vtk_components)
foreach (module IN LISTS brume_modules)
  foreach (kind IN ITEMS depends private_depends)
    get_property(depends TARGET ${module} PROPERTY "INTERFACE_vtk_module_${kind}")
    list(APPEND brume_vtk_components ${depends})
  endforeach ()
endforeach ()
list(FILTER brume_vtk_components INCLUDE REGEX "^VTK::")
list(TRANSFORM brume_vtk_components REPLACE "^VTK::" "")
list(REMOVE_DUPLICATES brume_vtk_components)
list(SORT brume_vtk_components)
list(JOIN brume_vtk_components " " brume_vtk_components)

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
