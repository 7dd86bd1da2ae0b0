# brume_add_library(NAME SOURCES … HEADERS … [PUBLIC …] [PRIVATE …])
#
# A library without VTK, in C++20 with C++17 headers. It is called Brume::NAME within the build and
# by those who install it. Its headers are included by their folder in this tree
# ("Transport/film.h"), and installed under the same path below include/brume.
# PUBLIC and PRIVATE name the libraries it links.
set(BRUME_INCLUDE_DIR "${CMAKE_INSTALL_INCLUDEDIR}/brume")

function (brume_add_library name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;HEADERS;PUBLIC;PRIVATE")
  add_library(${name} ${arg_SOURCES} ${arg_HEADERS})
  add_library(Brume::${name} ALIAS ${name})
  set_target_properties(${name} PROPERTIES
    OUTPUT_NAME "Brume${name}"
    CXX_STANDARD 20
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    WINDOWS_EXPORT_ALL_SYMBOLS ON
    CXX_VISIBILITY_PRESET default)
  get_filename_component(parent "${CMAKE_CURRENT_SOURCE_DIR}" DIRECTORY)
  get_filename_component(folder "${CMAKE_CURRENT_SOURCE_DIR}" NAME)
  target_include_directories(${name} PUBLIC
    "$<BUILD_INTERFACE:${parent}>" "$<INSTALL_INTERFACE:${BRUME_INCLUDE_DIR}>")
  target_link_libraries(${name} PUBLIC ${arg_PUBLIC} PRIVATE ${arg_PRIVATE})
  install(TARGETS ${name} EXPORT Brume
    RUNTIME DESTINATION "${CMAKE_INSTALL_BINDIR}"
    LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}"
    ARCHIVE DESTINATION "${CMAKE_INSTALL_LIBDIR}")
  install(FILES ${arg_HEADERS} DESTINATION "${BRUME_INCLUDE_DIR}/${folder}")
endfunction ()
