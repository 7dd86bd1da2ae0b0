# The switches of a Brume build, and what every target is compiled with.

option(BUILD_SHARED_LIBS "Build shared libraries" ON)
option(BRUME_BUILD_TESTING "Build the tests" ON)
option(BRUME_WARNINGS_AS_ERRORS "Treat compiler warnings as errors" OFF)
set(BRUME_SANITIZE "" CACHE STRING
  "Sanitizers for every target, as -fsanitize= takes them: address,undefined or thread")

if (NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release CACHE STRING "Build type" FORCE)
endif ()

# Files that include VTK are C++17 (VTK 9.1 does not compile as C++20 with every compiler);
# the libraries without VTK ask for C++20 themselves, their headers stay C++17.
set(CMAKE_CXX_STANDARD 17)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_BINDIR}")
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_ARCHIVE_OUTPUT_DIRECTORY "${CMAKE_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}")

# An installed program finds its own libraries beside it, wherever the tree is put.
file(RELATIVE_PATH _brume_bin_to_lib
  "/${CMAKE_INSTALL_BINDIR}" "/${CMAKE_INSTALL_LIBDIR}")
set(CMAKE_INSTALL_RPATH "$ORIGIN;$ORIGIN/${_brume_bin_to_lib}")

add_compile_options(-Wall -Wextra)
if (BRUME_WARNINGS_AS_ERRORS)
  add_compile_options(-Werror)
endif ()
if (BRUME_SANITIZE)
  # To build in good time: two of the kernels' instruction sets, and -O1 for the build type's level.
  add_compile_options(-fsanitize=${BRUME_SANITIZE} -fno-omit-frame-pointer
    -fno-sanitize-recover=all -O1)
  add_compile_definitions(
    "HWY_DISABLED_TARGETS=(HWY_SSSE3|HWY_SSE4|HWY_AVX3|HWY_AVX3_DL)")
  if (CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    add_compile_options(-Wno-maybe-uninitialized) # false alarms in <regex> under -fsanitize
  endif ()
  add_link_options(-fsanitize=${BRUME_SANITIZE})
endif ()

find_program(BRUME_CCACHE ccache)
if (BRUME_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER "${BRUME_CCACHE}")
endif ()
