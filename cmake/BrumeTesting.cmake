# brume_add_test(NAME LABEL unit|analytic|regression|app
#   SOURCES … LIBRARIES … [DISPLAY])
#
# One GoogleTest program and one CTest test of the same name and of one label. A test that cannot
# run here returns 77 and says why; CTest counts it as skipped. DISPLAY runs it under a private
# virtual display where the machine has none.
find_package(GTest REQUIRED)

function (brume_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "DISPLAY" "LABEL" "SOURCES;LIBRARIES")
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE
    BRUME_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    BRUME_TEST_BASELINES="${PROJECT_SOURCE_DIR}/tests/baselines"
    BRUME_TEST_OUTPUT="${PROJECT_BINARY_DIR}/tests/output")
  set(launcher)
  if (arg_DISPLAY)
    set(launcher "${PROJECT_SOURCE_DIR}/scripts/with-display")
  endif ()
  add_test(NAME ${name} COMMAND ${launcher} $<TARGET_FILE:${name}>)
  set_tests_properties(${name} PROPERTIES
    LABELS "${arg_LABEL}" SKIP_RETURN_CODE 77 TIMEOUT 300)
endfunction ()
