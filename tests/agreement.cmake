# SPDX-License-Identifier: Apache-2.0
# Tests that compare methods of several rooms with one another, and all of them with the exact decision.
set(soup_sources ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/soup_case.cpp ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/soup_judge.cpp
                 ${CMAKE_CURRENT_SOURCE_DIR}/fuzz/soup_methods.cpp)
penumbra_test(agreement FULL CorpusSweep.*
  SOURCES
  agreement/aimed_pairs.cpp
  agreement/tiny_lights.cpp
  agreement/broken_meshes_raytrace.cpp
  agreement/deep_stacks.cpp
  agreement/mesh/face_counters_binary.cpp
  agreement/mesh/face_counters_text.cpp
  agreement/hybrid_volume.cpp
  agreement/long_walks.cpp
  agreement/masks_raytrace.cpp
  agreement/mesh_verdicts.cpp
  agreement/method_table.cpp
  agreement/textured_lights_methods.cpp
  analytic/textured_lights_exact.cpp
  cli/corpus_sweep.cpp  # every mesh of two packages through inspect and compare; prints a table
  cli/program.cpp
  property/adversarial_soups.cpp
  property/mask_cones.cpp
  property/mask_lamps.cpp
  property/mask_lattice.cpp
  property/point_lights.cpp
  unit/textured_lights_files.cpp
  unit/textured_lights_weights.cpp
  ${soup_sources}
  LIBRARIES penumbra_session penumbra_compare penumbra_hybrids penumbra_maps penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes
            nlohmann_json::nlohmann_json PkgConfig::MINIZIP TBB::tbb ZLIB::ZLIB gmpxx gmp)
penumbra_cgal_corpus(agreement_test)
target_compile_definitions(agreement_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
add_dependencies(agreement_test penumbra)
