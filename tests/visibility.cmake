add_executable(visibility_tests
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_light_touch.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_lights.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_method.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_sample_patterns.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_scene_floats.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/visibility_view_samples.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/visibility_invariance.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/visibility_pair_truth.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/visibility_planes.cpp)
# GMP's rationals are the judge of the exact predicates: another library, another formula.
target_link_libraries(visibility_tests PRIVATE penumbra_visibility penumbra_warnings GTest::gtest_main gmpxx gmp)
gtest_discover_tests(visibility_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
