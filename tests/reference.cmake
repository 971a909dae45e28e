add_executable(reference_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/ray_traced_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/ray_traced_pairs.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/ray_traced_scales.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/ray_traced.cpp)
target_link_libraries(reference_tests PRIVATE penumbra_reference penumbra_warnings GTest::gtest_main)
gtest_discover_tests(reference_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
