# The coverage integral and the whole method at one view sample, in C++. No device.
find_library(RAPIDCHECK rapidcheck REQUIRED)

add_executable(coverage_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/coverage_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/coverage_exact_area.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/coverage_properties.cpp)
target_link_libraries(coverage_tests PRIVATE penumbra_wedges penumbra_reference penumbra_scenes penumbra_warnings ${RAPIDCHECK}
                                             GTest::gtest_main)
gtest_discover_tests(coverage_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
