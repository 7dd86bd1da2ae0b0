# How tests are declared. Every test carries one label, unit, analytic, stability, regression, app or benchmark;
# a test that cannot run here exits with 77 and says why on a line that begins with "skipped: ", and CTest
# counts it as skipped.
find_package(GTest REQUIRED)

# What runs under sanitizers: the programs of the labels unit, analytic and stability.
add_custom_target(sanitized-tests)

set(BRUME_TEST_OUTPUT "${PROJECT_BINARY_DIR}/tests/output")
add_library(BrumeTestMain STATIC "${PROJECT_SOURCE_DIR}/tests/main.cxx")
target_link_libraries(BrumeTestMain PUBLIC GTest::gtest)

# What every test has: its label, the skip status, a time limit, and under sanitizers the list of
# leaks that are other libraries' own.
function (_brume_set_test name label)
  set_tests_properties(${name} PROPERTIES
    LABELS "${label}" SKIP_RETURN_CODE 77 TIMEOUT 900) # ten times what the longest take
  if (BRUME_SANITIZE)
    set(suppressions "${PROJECT_SOURCE_DIR}/tests/sanitizers")
    set_tests_properties(${name} PROPERTIES TIMEOUT 1200 ENVIRONMENT
      "LSAN_OPTIONS=suppressions=${suppressions}/leaks.txt:print_suppressions=0;TSAN_OPTIONS=suppressions=${suppressions}/threads.txt;UBSAN_OPTIONS=print_stacktrace=1")
  endif ()
endfunction ()

# brume_add_test(NAME LABEL unit|analytic|stability|regression|app|benchmark
#   SOURCES … LIBRARIES … [ARGUMENTS …] [DISPLAY] [SERIAL])
#
# One GoogleTest program (or one with a main() of its own) and one CTest test of the same name, which
# calls it with the ARGUMENTS. DISPLAY runs it under a private
# virtual display where the machine has none, one such test at a time. SERIAL runs it while no other
# test does: for tests that take the time.
function (brume_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "DISPLAY;SERIAL" "LABEL" "SOURCES;LIBRARIES;ARGUMENTS")
  add_executable(${name} ${arg_SOURCES})
  set_target_properties(${name} PROPERTIES
    RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/tests")
  target_link_libraries(${name} PRIVATE ${arg_LIBRARIES} BrumeTestMain)
  target_compile_definitions(${name} PRIVATE
    BRUME_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data"
    BRUME_TEST_BASELINES="${PROJECT_SOURCE_DIR}/tests/baselines"
    BRUME_TEST_OUTPUT="${BRUME_TEST_OUTPUT}")
  if (arg_LABEL MATCHES "^(unit|regression)$")
    # What is tested is in the libraries; the tests' own code is compiled a third sooner so. Oracles of
    # analytic tests and benchmarks want their own speed.
    target_compile_options(${name} PRIVATE $<$<CONFIG:Release>:-O1>)
  endif ()
  set(launcher)
  if (arg_DISPLAY)
    set(launcher "${PROJECT_SOURCE_DIR}/scripts/with-display")
  endif ()
  if (arg_LABEL MATCHES "^(unit|analytic|stability)$")
    add_dependencies(sanitized-tests ${name})
  endif ()
  add_test(NAME ${name} COMMAND ${launcher} $<TARGET_FILE:${name}> ${arg_ARGUMENTS})
  _brume_set_test(${name} "${arg_LABEL}")
  if (arg_DISPLAY)
    set_tests_properties(${name} PROPERTIES RESOURCE_LOCK display)
  endif ()
  if (arg_SERIAL)
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif ()
endfunction ()

# brume_add_app_test(FILE.sh [DISPLAY] [SERIAL])
#
# One CTest test, app-FILE, of the program as its users call it: FILE.sh is a list of cases in the
# words of tests/app/lib.sh. Each case runs in an empty folder of its own.
function (brume_add_app_test file)
  cmake_parse_arguments(PARSE_ARGV 1 arg "DISPLAY;SERIAL" "" "")
  get_filename_component(stem "${file}" NAME_WE)
  set(name "app-${stem}")
  set(launcher)
  if (arg_DISPLAY)
    set(launcher "${PROJECT_SOURCE_DIR}/scripts/with-display")
  endif ()
  add_test(NAME ${name} COMMAND ${launcher} bash "${PROJECT_SOURCE_DIR}/tests/app/run-cases"
    "$<TARGET_FILE:brume>" "${BRUME_TEST_OUTPUT}/${name}" "${CMAKE_CURRENT_SOURCE_DIR}/${file}")
  _brume_set_test(${name} app)
  if (arg_DISPLAY)
    set_tests_properties(${name} PROPERTIES RESOURCE_LOCK display)
  endif ()
  if (arg_SERIAL)
    set_tests_properties(${name} PROPERTIES RUN_SERIAL ON)
  endif ()
endfunction ()
