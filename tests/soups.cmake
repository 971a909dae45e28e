# Small adversarial scenes against a judge of their own: random ones here, found ones as a fuzz target.
set(soup_sources ${CMAKE_CURRENT_LIST_DIR}/fuzz/soup_case.cpp ${CMAKE_CURRENT_LIST_DIR}/fuzz/soup_judge.cpp
                 ${CMAKE_CURRENT_LIST_DIR}/fuzz/soup_methods.cpp)
add_executable(soup_tests ${CMAKE_CURRENT_LIST_DIR}/property/adversarial_soups.cpp ${soup_sources})
target_link_libraries(soup_tests PRIVATE penumbra_volumes penumbra_vsm penumbra_warnings gmpxx gmp GTest::gtest_main)
gtest_discover_tests(soup_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(soup_tests TEST_FILTER "*Full" TEST_LIST soup_tests_full
                     PROPERTIES LABELS full TIMEOUT 7200 DISCOVERY_TIMEOUT 120)
penumbra_fuzz_target(soups penumbra_volumes penumbra_vsm gmpxx gmp)
target_sources(fuzz_soups PRIVATE ${soup_sources})
