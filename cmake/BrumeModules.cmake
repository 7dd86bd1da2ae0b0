# The VTK modules of Brume: every folder below modules/ that declares itself in a vtk.module file.

vtk_module_find_modules(brume_module_files "${PROJECT_SOURCE_DIR}/modules")
vtk_module_scan(
  MODULE_FILES ${brume_module_files}
  PROVIDES_MODULES brume_modules
  WANT_BY_DEFAULT ON
  ENABLE_TESTS OFF)
vtk_module_build(
  MODULES ${brume_modules}
  PACKAGE Brume
  INSTALL_EXPORT Brume
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  HEADERS_DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/brume"
  CMAKE_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/Brume"
  TEST_DIRECTORY_NAME NONE)
