# edge-scatter without light samples against exact areas.
add_executable(exact_rows_tests
  ${CMAKE_CURRENT_LIST_DIR}/agreement/exact_rows.cpp ${CMAKE_CURRENT_LIST_DIR}/property/row_sweep.cpp)
target_compile_definitions(exact_rows_tests PRIVATE
  PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes" PENUMBRA_TEST_LAMPS="${CMAKE_CURRENT_LIST_DIR}/lamps")
target_link_libraries(exact_rows_tests PRIVATE
  penumbra_volumes penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(exact_rows_tests TEST_FILTER "-*Full*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(exact_rows_tests TEST_FILTER "*Full*" TEST_LIST exact_rows_full_tests
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 7200)
