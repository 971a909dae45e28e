# SPDX-License-Identifier: Apache-2.0
# Tests penumbra-bench from outside: its lines parse and its names stay the same. Times are not tested.
if(NOT PENUMBRA_BENCH)
  return()
endif()
penumbra_test(bench
  SOURCES cli/bench.cpp cli/program.cpp unit/moved_light.cpp ${PROJECT_SOURCE_DIR}/bench/moved_light.cpp
  LIBRARIES penumbra_base penumbra_scenes nlohmann_json::nlohmann_json)
target_compile_definitions(bench_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra-bench>")
add_dependencies(bench_test penumbra-bench)
