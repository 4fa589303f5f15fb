# stereovox_stage(<name> SOURCES ... [TESTS ...] [LINKS ...] [PRIVATE_LINKS ...])
#
# One folder of src/stereovox = one static library stereovox::<name> = one test program <name>_test.

add_library(stereovox_options INTERFACE)
target_compile_features(stereovox_options INTERFACE cxx_std_20)
# Fused multiply-adds would make results depend on the compiler and the machine.
target_compile_options(stereovox_options INTERFACE -ffp-contract=off)

add_library(stereovox_build_options INTERFACE)
target_link_libraries(stereovox_build_options INTERFACE stereovox_options)
target_compile_options(stereovox_build_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Woverloaded-virtual -Wcast-qual
  -Wimplicit-fallthrough -Wunused
  # g++ 12 raises these wrongly on std::string (PR 105329, PR 105651).
  -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow -Wno-stringop-overread
  $<$<BOOL:${STEREOVOX_WARNINGS_AS_ERRORS}>:-Werror>)
if(STEREOVOX_ASSERTIONS)
  target_compile_options(stereovox_build_options INTERFACE -UNDEBUG)
endif()
if(STEREOVOX_SANITIZER)
  target_compile_options(stereovox_build_options INTERFACE
    -fsanitize=${STEREOVOX_SANITIZER} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(stereovox_build_options INTERFACE -fsanitize=${STEREOVOX_SANITIZER})
endif()

# The large headers that nearly every file needs, parsed once: one set for the libraries, which are
# position independent, one with GoogleTest for the test programs.
set(precompiled_headers <algorithm> <filesystem> <functional> <map> <optional> <string> <vector>
  <Eigen/Core> <Eigen/Geometry> <opencv2/core.hpp> <fmt/format.h>)

function(stereovox_precompile_headers target owner)
  if(NOT STEREOVOX_PRECOMPILED_HEADERS)
    return()
  endif()
  if(TARGET ${owner} AND NOT ${target} STREQUAL ${owner})
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE ${precompiled_headers} ${ARGN})
  endif()
endfunction()

# Several files at once, which parses what they share once: test programs always, libraries only
# under a sanitizer, so that other builds see that each file includes what it needs. Plain versions
# of kernels have the names of the fast ones, so they stay alone.
function(stereovox_compile_together target)
  get_target_property(sources ${target} SOURCES)
  list(FILTER sources INCLUDE REGEX "_reference\\.cpp$")
  set_source_files_properties(${sources} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 5)
endfunction()

function(stereovox_stage name)
  cmake_parse_arguments(STAGE "" "" "SOURCES;TESTS;LINKS;PRIVATE_LINKS" ${ARGN})
  set(target stereovox_${name})
  add_library(${target} STATIC ${STAGE_SOURCES})
  add_library(stereovox::${name} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON)
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:include>)
  target_link_libraries(${target} PUBLIC stereovox_options ${STAGE_LINKS}
    PRIVATE ${STAGE_PRIVATE_LINKS} $<BUILD_INTERFACE:stereovox_build_options>)
  stereovox_precompile_headers(${target} stereovox_core)
  if(STEREOVOX_SANITIZER)
    stereovox_compile_together(${target})
  endif()
  set_property(GLOBAL APPEND PROPERTY STEREOVOX_STAGES ${target})
  if(STEREOVOX_TESTS AND STAGE_TESTS)
    stereovox_test(${name}_test SOURCES ${STAGE_TESTS} LINKS ${target} ${STAGE_PRIVATE_LINKS})
  endif()
endfunction()

# Two ctest entries, each of which runs every second TEST: a sanitizer takes long to start.
function(stereovox_add_halves program)
  foreach(half 0 1)
    add_test(NAME ${program}_${half} COMMAND ${program})
    set_tests_properties(${program}_${half} PROPERTIES
      ENVIRONMENT "GTEST_TOTAL_SHARDS=2;GTEST_SHARD_INDEX=${half}")
  endforeach()
endfunction()

# stereovox_test(<program> SOURCES ... [LINKS ...]): a GoogleTest program; every TEST is a ctest entry,
# but not under a sanitizer.
function(stereovox_test program)
  cmake_parse_arguments(TEST "" "" "SOURCES;LINKS" ${ARGN})
  add_executable(${program} ${TEST_SOURCES})
  target_link_libraries(${program} PRIVATE ${TEST_LINKS} stereovox_build_options GTest::gmock GTest::gtest_main)
  target_compile_definitions(${program} PRIVATE
    STEREOVOX_SOURCE_DIR="${PROJECT_SOURCE_DIR}" STEREOVOX_SHARED_DIR="${PROJECT_SOURCE_DIR}/../shared")
  stereovox_precompile_headers(${program} core_test <gmock/gmock.h> <gtest/gtest.h>)
  stereovox_compile_together(${program})
  if(STEREOVOX_SANITIZER)
    stereovox_add_halves(${program})
  else()
    gtest_discover_tests(${program} DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
