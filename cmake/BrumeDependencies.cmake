# Every library that Brume stands on. What a test alone needs is found in BrumeTesting.

find_package(Threads REQUIRED)
find_package(glm REQUIRED)
find_package(TBB REQUIRED COMPONENTS tbb)
find_package(hwy REQUIRED)
find_package(ZLIB REQUIRED)

find_package(MPI QUIET COMPONENTS C) # VTK's Debian package names MPI::MPI_C without finding it
find_package(VTK 9.1 REQUIRED COMPONENTS
  CommonCore CommonDataModel CommonExecutionModel CommonMath CommonMisc CommonTransforms
  CommonSystem FiltersCore IOCore IOGeometry IOImage IOLegacy IOPLY IOXML ImagingCore
  RenderingCore RenderingVolume RenderingOpenGL2 RenderingVolumeOpenGL2 RenderingFreeType
  InteractionStyle FiltersSources ChartsCore RenderingContext2D RenderingContextOpenGL2)

find_package(DICOM 0.8 REQUIRED) # vtk-dicom; it gives VTK::DICOM
# The decoders of compressed DICOM, which vtk-dicom links too. GDCM's own package file asks for its tools.
find_path(BRUME_GDCM_INCLUDE_DIR gdcmImageReader.h PATH_SUFFIXES gdcm-3.0 REQUIRED)
mark_as_advanced(BRUME_GDCM_INCLUDE_DIR)
add_library(brume_gdcm INTERFACE IMPORTED)
target_include_directories(brume_gdcm SYSTEM INTERFACE "${BRUME_GDCM_INCLUDE_DIR}")
foreach (_name IN ITEMS MSFF DSED Common)
  find_library(BRUME_GDCM_${_name} gdcm${_name} REQUIRED)
  mark_as_advanced(BRUME_GDCM_${_name})
  target_link_libraries(brume_gdcm INTERFACE "${BRUME_GDCM_${_name}}")
endforeach ()

# QUIET: Imath's Debian package names a Python library that it does not bring, and says so at length.
find_package(OpenImageIO 2.4 REQUIRED QUIET)
# Debian's OpenImageIO target names an include folder of OpenCV that its package does not bring.
get_target_property(_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER _oiio_includes EXCLUDE REGEX "opencv")
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
  INTERFACE_INCLUDE_DIRECTORIES "${_oiio_includes}")

# OpenVDB comes with a find module, in a folder of its own beside its library.
find_path(BRUME_OPENVDB_CMAKE_DIR FindOpenVDB.cmake
  PATHS ${CMAKE_PREFIX_PATH} ${CMAKE_SYSTEM_PREFIX_PATH}
  PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib64/cmake/OpenVDB
    lib/cmake/OpenVDB cmake/OpenVDB
  DOC "The folder of FindOpenVDB.cmake")
mark_as_advanced(BRUME_OPENVDB_CMAKE_DIR)
list(APPEND CMAKE_MODULE_PATH "${BRUME_OPENVDB_CMAKE_DIR}")
find_package(OpenVDB 10 REQUIRED COMPONENTS openvdb)

find_package(CLI11 REQUIRED)
find_package(nlohmann_json 3.11 REQUIRED)
find_package(X11 REQUIRED) # the program asks whether a display can be opened

if (BRUME_BUILD_TESTING)
  find_package(benchmark REQUIRED) # tests/benchmarks
endif ()
