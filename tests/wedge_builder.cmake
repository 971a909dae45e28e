# Silhouettes and penumbra wedges that the device builds, against the host's and against exact signs.
add_executable(wedge_builder_tests
  ${CMAKE_CURRENT_LIST_DIR}/property/silhouette_pass.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/wedge_builder.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/soft_volume_wedges.cpp)
target_compile_definitions(wedge_builder_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(wedge_builder_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(wedge_builder_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(wedge_builder_tests TEST_FILTER "*Full" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
