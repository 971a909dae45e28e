# base's images, and all of compare.
find_package(OpenEXR REQUIRED)
find_package(TBB REQUIRED)

add_executable(image_test ${CMAKE_CURRENT_SOURCE_DIR}/unit/image_test.cpp ${CMAKE_CURRENT_SOURCE_DIR}/unit/exr_test.cpp)
target_link_libraries(image_test PRIVATE penumbra_base penumbra_warnings OpenEXR::OpenEXR GTest::gtest_main)
gtest_discover_tests(image_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(bits_file_test ${CMAKE_CURRENT_SOURCE_DIR}/unit/bits_file_test.cpp)
target_link_libraries(bits_file_test PRIVATE penumbra_visibility penumbra_warnings GTest::gtest_main)
gtest_discover_tests(bits_file_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(compare_test
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare_beauty_test.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare_metrics_test.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare_picture_test.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare_report_test.cpp
  ${CMAKE_CURRENT_SOURCE_DIR}/unit/compare_stats_test.cpp)
target_link_libraries(compare_test PRIVATE penumbra_compare penumbra_warnings TBB::tbb GTest::gtest_main)
gtest_discover_tests(compare_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
