# View-sample mapping, and edge scatter, against the exact decision, closed forms and the ray caster.
find_package(TBB REQUIRED)
add_executable(vsm_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/view_sample_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/cut_ends.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/edge_cut.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/view_sample_closed_parts.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/view_sample_invariance.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/mask_lamps.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/mask_lattice.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/view_sample_patterns.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/view_sample_triangle_tree.cpp)
add_executable(agreement_tests
  ${CMAKE_CURRENT_LIST_DIR}/agreement/long_walks.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/masks_raytrace.cpp)
foreach(target vsm_tests agreement_tests)
  target_compile_definitions(${target} PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
  target_link_libraries(${target} PRIVATE
    penumbra_vsm penumbra_volumes penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb gmpxx gmp)
endforeach()
gtest_discover_tests(vsm_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(vsm_tests TEST_FILTER "*Full*" TEST_LIST vsm_full_tests
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 7200)
gtest_discover_tests(agreement_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(agreement_tests TEST_FILTER "*Full*" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
