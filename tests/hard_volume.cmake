# Shadow volumes of the light's centre against the exact count.
add_executable(hard_volume_tests ${CMAKE_CURRENT_LIST_DIR}/property/hard_volume_exact.cpp)
target_compile_definitions(hard_volume_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(hard_volume_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(hard_volume_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(hard_volume_tests TEST_FILTER "*Full" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
