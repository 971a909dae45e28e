# Penumbra wedges: bounds proved by exact signs. No device.
add_executable(wedges_tests ${CMAKE_CURRENT_LIST_DIR}/property/penumbra_wedges.cpp)
target_link_libraries(wedges_tests PRIVATE penumbra_wedges penumbra_warnings GTest::gtest_main)
gtest_discover_tests(wedges_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
