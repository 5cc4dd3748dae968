# Flags every Taut target is built with. No -ffast-math, and contraction off: results must not depend on the compiler.
function(taut_configure_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -ffp-contract=off)
  if(TAUT_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
endfunction()

# taut_precompile(target headers...): reads Eigen, the standard library and the named headers once for a target, not once
# a source: that was two thirds of the time a source took. The dev preset leaves it out, so that each source is seen to
# include what it uses.
function(taut_precompile target)
  target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory>
    <optional> <random> <span> <string> <string_view> <unordered_map> <utility> <vector>
    <Eigen/Core> <Eigen/Geometry> <Eigen/QR> <Eigen/Eigenvalues> <Eigen/Cholesky> ${ARGN})
endfunction()

# taut_room(NAME HEADERS a.hpp ... SOURCES b.cpp ...): adds one room of the house to the library. Headers are public,
# relative to include/taut/NAME; sources are relative to the calling folder.
function(taut_room name)
  cmake_parse_arguments(PARSE_ARGV 1 ROOM "" "" "HEADERS;SOURCES")
  list(TRANSFORM ROOM_HEADERS PREPEND "${PROJECT_SOURCE_DIR}/include/taut/${name}/")
  list(TRANSFORM ROOM_SOURCES PREPEND "${CMAKE_CURRENT_SOURCE_DIR}/")
  target_sources(taut PRIVATE ${ROOM_SOURCES})
  target_sources(taut PUBLIC FILE_SET HEADERS FILES ${ROOM_HEADERS})
endfunction()

# taut_test(ROOM test_a.cpp ...): one test program a room, each of its tests known to ctest.
function(taut_test room)
  add_executable(test_${room} ${ARGN})
  taut_configure_target(test_${room})
  target_compile_options(test_${room} PRIVATE $<$<CONFIG:Release>:-O1>)  # built quickly; the library is what runs
  target_include_directories(test_${room} PRIVATE "${PROJECT_SOURCE_DIR}/tests")
  target_compile_definitions(test_${room} PRIVATE TAUT_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  target_link_libraries(test_${room} PRIVATE taut::taut GTest::gmock GTest::gtest_main)
  taut_precompile(test_${room} <gtest/gtest.h>)
  gtest_discover_tests(test_${room} DISCOVERY_MODE PRE_TEST PROPERTIES TIMEOUT 600)
endfunction()
