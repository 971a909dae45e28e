# Form factors, and the beauty that is made of them. No device.
find_package(TBB REQUIRED)
add_executable(radiance_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/form_factor_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/analytic/radiance_exact.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/radiance_near_light.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/compare_visible_light.cpp)
target_link_libraries(radiance_tests PRIVATE penumbra_compare penumbra_reference penumbra_warnings TBB::tbb
  GTest::gtest_main)
gtest_discover_tests(radiance_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
