# The coverage integral of lights that are no plain polygon or disk: textured ones and spheres. No device.
find_library(RAPIDCHECK rapidcheck REQUIRED)
add_executable(coverage_light_tests ${CMAKE_CURRENT_LIST_DIR}/agreement/coverage_lights.cpp
                                    ${CMAKE_CURRENT_LIST_DIR}/property/coverage_textures.cpp)
target_link_libraries(coverage_light_tests PRIVATE penumbra_wedges penumbra_reference penumbra_scenes penumbra_warnings
                                                   ${RAPIDCHECK} GTest::gtest_main)
gtest_discover_tests(coverage_light_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
