# Depth complexity against exact predicates, exact layer counts, the ray caster and edge scatter.
find_package(TBB REQUIRED)
add_executable(depth_complexity_tests
  ${CMAKE_CURRENT_LIST_DIR}/property/depth_complexity_lattice.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/depth_complexity_counters.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/depth_complexity_scenes.cpp)
target_compile_definitions(depth_complexity_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(depth_complexity_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(depth_complexity_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(depth_complexity_tests TEST_FILTER "*Full*" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 1800)
