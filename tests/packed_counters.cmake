# depth-complexity variant=forest against its twins, exact predicates and the ray caster; cropping of edges.
find_package(TBB REQUIRED)
add_executable(packed_counters_tests
  ${CMAKE_CURRENT_LIST_DIR}/property/packed_counters.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/packed_counters_scenes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/edge_crop.cpp)
target_compile_definitions(packed_counters_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(packed_counters_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(packed_counters_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(packed_counters_tests TEST_FILTER "*Full*" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 1800)
