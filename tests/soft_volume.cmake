# Soft shadow volumes on the device against their C++ twin and exact areas.
add_executable(soft_volume_tests
  ${CMAKE_CURRENT_LIST_DIR}/agreement/soft_volume_twin.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/soft_volume_exact.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/soft_volume_measures.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/wedge_ramp.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/soft_volume_blend.cpp)
target_compile_definitions(soft_volume_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(soft_volume_tests PRIVATE
  penumbra_volumes penumbra_vsm penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(soft_volume_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(soft_volume_tests TEST_FILTER "*Full" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)
