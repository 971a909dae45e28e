# SPDX-License-Identifier: Apache-2.0
# Headers of libraries included by nearly every file are parsed once (about half of the compiler's time was spent on
# them). Files still include what they use: preset `dev` builds without precompiled headers, and reports missing
# includes.
#   penumbra_precompile(target…)        the standard library, fmt, GLM, and nlohmann-json
#   penumbra_precompile_tests(target)   these and GoogleTest
# penumbra_seldom(target…) compiles code that runs once per command, and only briefly, with -O1: a third less of the
# compiler's time.
set(PENUMBRA_PRECOMPILED
  <algorithm> <array> <atomic> <bit> <charconv> <chrono> <cmath> <cstddef> <cstdint> <cstdio> <cstdlib> <cstring> <filesystem>
  <fstream> <functional> <limits> <map> <memory> <mutex> <numbers> <numeric> <optional> <set> <span> <stdexcept> <string>
  <string_view> <system_error> <thread> <tuple> <unordered_map> <utility> <variant> <vector>
  <fmt/format.h> <fmt/ranges.h> <glm/glm.hpp> <nlohmann/json.hpp>)

# Without optimisation, fmt 9 requests optimisation of its own lines from g++ by pragma. In a precompiled header, g++ 12
# does not end that request: __OPTIMIZE__ stays defined, so that intrinsics are functions instead of macros, and their
# immediates are not constants.
add_compile_options("$<$<AND:$<CXX_COMPILER_ID:GNU>,$<CONFIG:Debug>>:-DFMT_GCC_PRAGMA(text)=>")

find_package(fmt REQUIRED)
find_package(glm REQUIRED)
find_package(nlohmann_json REQUIRED)

function(penumbra_precompiled_headers name)
  add_library(${name} OBJECT ${PROJECT_SOURCE_DIR}/cmake/precompiled.cpp)
  target_link_libraries(${name} PRIVATE penumbra_warnings fmt::fmt glm::glm nlohmann_json::nlohmann_json)
  target_precompile_headers(${name} PRIVATE ${PENUMBRA_PRECOMPILED} ${ARGN})
endfunction()
penumbra_precompiled_headers(penumbra_precompiled)

function(penumbra_precompile)
  foreach(target ${ARGN})
    target_precompile_headers(${target} REUSE_FROM penumbra_precompiled)
  endforeach()
endfunction()

function(penumbra_seldom)
  foreach(target ${ARGN})
    # At -O1 g++ 12 warns falsely of a variable in a header of CGAL.
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1> $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
  endforeach()
endfunction()

# penumbra_join(target [APART file…]): the target's files are compiled as one, up to sixty at a time (app's 58 files
# take 62 CPU seconds in this form, and 95 ten at a time). Compiled separately are the files in APART (files that own a
# hidden type, or have an internal name that another file also has), and files that Highway compiles once for each
# vector target.
function(penumbra_join target)
  cmake_parse_arguments(ARG "" "" "APART" ${ARGN})
  if(PENUMBRA_JOIN OR NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 60)
    # With more to inline, g++ 12 warns falsely about std::string and std::optional (as in GCC bugs 105651 and 80635).
    # Where files are compiled separately, these warnings stay errors.
    target_compile_options(${target} PRIVATE "$<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds;-Wno-maybe-uninitialized>")
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "^[^/$][^$]*\\.cpp$")
    foreach(source ${sources})
      file(STRINGS ${CMAKE_CURRENT_SOURCE_DIR}/${source} once_a_target REGEX "hwy/foreach_target\\.h" LIMIT_COUNT 1)
      if(once_a_target)
        list(APPEND ARG_APART ${source})
      endif()
    endforeach()
    set_source_files_properties(${ARG_APART} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
  endif()
endfunction()

function(penumbra_precompile_tests target)
  if(NOT TARGET penumbra_precompiled_tests)
    penumbra_precompiled_headers(penumbra_precompiled_tests <gtest/gtest.h> <gmock/gmock.h>)
    target_link_libraries(penumbra_precompiled_tests PRIVATE GTest::gmock)
    target_compile_options(penumbra_precompiled_tests PRIVATE $<$<CONFIG:Release>:-O1>)
  endif()
  target_precompile_headers(${target} REUSE_FROM penumbra_precompiled_tests)
endfunction()
