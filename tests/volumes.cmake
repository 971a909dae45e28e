# The shadow-volume family on a device, against exact predicates.
add_executable(volumes_tests ${CMAKE_CURRENT_LIST_DIR}/property/facing_pass.cpp)
target_link_libraries(volumes_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(volumes_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(volumes_tests TEST_FILTER "*Full*" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
