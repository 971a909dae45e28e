# SPDX-License-Identifier: Apache-2.0
# Fuzz targets. Every build replays the corpus (label quick). The preset `fuzz` links the same code with libFuzzer, and
# its tests (label full) search for ten minutes each; in other builds the tests of these names configure and build that
# preset first.
set(PENUMBRA_FUZZ_SECONDS 600 CACHE STRING "How long each fuzz target runs")
add_custom_target(penumbra_fuzz)

# penumbra_fuzz_target(name libraries…): tests/fuzz/name.cpp with tests/fuzz/corpus/name and perhaps tests/fuzz/name.dict.
function(penumbra_fuzz_target name)
  set(folder ${CMAKE_CURRENT_SOURCE_DIR}/fuzz)
  set(target fuzz_${name})
  add_executable(${target} ${folder}/${name}.cpp)
  target_link_libraries(${target} PRIVATE ${ARGN} penumbra_warnings)
  add_dependencies(penumbra_fuzz ${target})
  if(PENUMBRA_FUZZ)
    target_link_options(${target} PRIVATE -fsanitize=fuzzer)
    add_test(NAME fuzz_replay.${name} COMMAND ${target} -runs=0 ${folder}/corpus/${name})
  else()
    target_sources(${target} PRIVATE ${folder}/replay_main.cpp)
    add_test(NAME fuzz_replay.${name} COMMAND ${target} ${folder}/corpus/${name})
  endif()
  add_test(NAME fuzz.${name}
           COMMAND ${folder}/run.sh ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR} ${name} ${PENUMBRA_FUZZ_SECONDS})
  set_tests_properties(fuzz_replay.${name} PROPERTIES LABELS quick TIMEOUT 120)
  # RUN_SERIAL: the first of them builds for all.
  math(EXPR timeout "${PENUMBRA_FUZZ_SECONDS} + 3600")
  set_tests_properties(fuzz.${name} PROPERTIES LABELS full RUN_SERIAL ON TIMEOUT ${timeout})
  set_property(TEST fuzz_replay.${name} fuzz.${name} PROPERTY ENVIRONMENT
    "LSAN_OPTIONS=suppressions=${CMAKE_CURRENT_SOURCE_DIR}/sanitizers/leak.supp:print_suppressions=0"
    "UBSAN_OPTIONS=print_stacktrace=1")
endfunction()

penumbra_fuzz_target(edge_graph penumbra_mesh)
penumbra_fuzz_target(off penumbra_mesh_reader penumbra_base)
penumbra_fuzz_target(mesh_reader penumbra_mesh_reader penumbra_base)
penumbra_fuzz_target(scene_json penumbra_scenes nlohmann_json::nlohmann_json)
penumbra_fuzz_target(three_ds penumbra_mesh_reader penumbra_base)
penumbra_fuzz_target(gltf penumbra_gltf_import penumbra_scenes penumbra_base)
penumbra_fuzz_target(texture penumbra_gltf_import penumbra_base)
if(PENUMBRA_WITH_CGAL_GPL)
  penumbra_fuzz_target(repair penumbra_repair penumbra_mesh)
endif()
penumbra_fuzz_target(pipe_messages penumbra_app nlohmann_json::nlohmann_json)
penumbra_fuzz_target(space_requests penumbra_app penumbra_network)
penumbra_fuzz_target(soups penumbra_volumes penumbra_vsm gmpxx gmp)
target_sources(fuzz_soups PRIVATE fuzz/soup_case.cpp fuzz/soup_judge.cpp fuzz/soup_methods.cpp)
