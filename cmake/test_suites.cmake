# SPDX-License-Identifier: Apache-2.0
# penumbra_discover_suites(target [PREFIX p] FULL pattern… [SHARDS suite=n…]): adds each test suite of a GoogleTest
# executable to ctest as one test, hence one process in which a device, and fixtures shared by tests, are made once. The
# tests that match a pattern of FULL have the label full, all others quick; a suite with both kinds is two tests of
# ctest, `suite` and `suite.full`. The quick tests of a suite in SHARDS are n tests of ctest, `suite.1of<n>` and so on.
# If the environment of ctest has PENUMBRA_SINGLE_TESTS, each test is a test of ctest by its own name instead.
#
# This file is also the script that lists the executable's tests after each link and writes the file included by ctest.
if(NOT CMAKE_SCRIPT_MODE_FILE)
  set(PENUMBRA_TEST_SUITES_SCRIPT ${CMAKE_CURRENT_LIST_FILE})
  function(penumbra_discover_suites target)
    cmake_parse_arguments(ARG "" "PREFIX" "FULL;SHARDS" ${ARGN})
    set(file ${CMAKE_CURRENT_BINARY_DIR}/${target}_suites)
    list(JOIN ARG_FULL ":" full)
    list(JOIN ARG_SHARDS ":" shards)
    add_custom_command(TARGET ${target} POST_BUILD
      COMMAND ${CMAKE_COMMAND} "-DEXECUTABLE=$<TARGET_FILE:${target}>" "-DFILE=${file}" "-DPREFIX=${ARG_PREFIX}" "-DFULL=${full}"
              "-DSHARDS=${shards}" -P ${PENUMBRA_TEST_SUITES_SCRIPT}
      BYPRODUCTS ${file}.cmake ${file}_single.cmake VERBATIM)
    file(CONFIGURE OUTPUT ${file}_include.cmake @ONLY CONTENT [[
if(NOT EXISTS "@file@.cmake")
  add_test(@target@_NOT_BUILT @target@_NOT_BUILT)
elseif(DEFINED ENV{PENUMBRA_SINGLE_TESTS})
  include("@file@_single.cmake")
else()
  include("@file@.cmake")
endif()
]])
    # relinks when this file changes
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${PENUMBRA_TEST_SUITES_SCRIPT})
    set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${file}_include.cmake)
  endfunction()
  return()
endif()
cmake_minimum_required(VERSION 3.25)

# list_tests(filter variable): lists the names of the tests that match, suite.test.
function(list_tests filter variable)
  execute_process(COMMAND ${EXECUTABLE} --gtest_list_tests --gtest_filter=${filter}
                  OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY TIMEOUT 120)
  string(REGEX REPLACE " +#[^\n]*" "" listing "\n${listing}")  # removes the values of parameters
  string(REGEX MATCHALL "\n(  [A-Za-z0-9_/]+|[A-Za-z0-9_/]+\\.)" lines "${listing}")
  set(tests)
  foreach(line ${lines})
    string(STRIP "${line}" name)
    if(name MATCHES "\\.$")
      set(suite ${name})
    else()
      list(APPEND tests ${suite}${name})
    endif()
  endforeach()
  set(${variable} ${tests} PARENT_SCOPE)
endfunction()

# append_test(variable name label filter [environment…])
# Adds a test of ctest, which counts as skipped if GoogleTest skipped all of its tests: then its summary ends with their
# names.
function(append_test variable name label filter)
  set(name "[=[${PREFIX}${name}]=]")
  set(properties "LABELS ${label}")
  if(label STREQUAL full)
    string(APPEND properties " TIMEOUT 21600")
  endif()
  if(ARGN)
    string(APPEND properties " ENVIRONMENT \"${ARGN}\"")
  endif()
  string(APPEND ${variable}
    "add_test(${name} [=[${EXECUTABLE}]=] [=[--gtest_filter=${filter}]=])\n"
    "set_tests_properties(${name} PROPERTIES ${properties} SKIP_REGULAR_EXPRESSION "
    "[=[ 0 tests\\.\n\\[  SKIPPED \\] [0-9]+ tests?, listed below:\n(\\[  SKIPPED \\] [^\n]*\n*)+$]=])\n")
  set(${variable} "${${variable}}" PARENT_SCOPE)
endfunction()

list_tests(* tests)
list_tests(${FULL} full_tests)
set(single "")
set(suites)
foreach(test ${tests})
  if(test IN_LIST full_tests)
    set(label full)
  else()
    set(label quick)
  endif()
  append_test(single ${test} ${label} ${test})
  string(REGEX REPLACE "\\..*" "" suite ${test})
  list(APPEND suites ${suite})
  list(APPEND ${label}_of_${suite} ${test})
endforeach()
list(REMOVE_DUPLICATES suites)

set(text "")
foreach(suite ${suites})
  if(NOT full_of_${suite})
    set(quick_filter "${suite}.*")
  else()
    set(quick_filter "${suite}.*-${FULL}")
  endif()
  if(NOT quick_of_${suite})
    append_test(text ${suite} full "${suite}.*")
  elseif(full_of_${suite})
    list(JOIN full_of_${suite} ":" filter)
    append_test(text ${suite}.full full "${filter}")
  endif()
  if(quick_of_${suite})
    string(REPLACE ":" ";" shards "${SHARDS}")
    list(FILTER shards INCLUDE REGEX "^${suite}=")
    if(shards)
      string(REGEX REPLACE ".*=" "" shards ${shards})
      foreach(i RANGE 1 ${shards})
        math(EXPR index "${i} - 1")
        append_test(text ${suite}.${i}of${shards} quick "${quick_filter}" "GTEST_TOTAL_SHARDS=${shards};GTEST_SHARD_INDEX=${index}")
      endforeach()
    else()
      append_test(text ${suite} quick "${quick_filter}")
    endif()
  endif()
endforeach()
file(WRITE ${FILE}.cmake "${text}")
file(WRITE ${FILE}_single.cmake "${single}")
