# The coverage integral and the whole method at one view sample, in C++. No device.
find_library(RAPIDCHECK rapidcheck REQUIRED)

add_executable(coverage_tests
  ${CMAKE_CURRENT_LIST_DIR}/analytic/coverage_closed_forms.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/coverage_errors.cpp
  ${CMAKE_CURRENT_LIST_DIR}/agreement/coverage_exact_area.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/coverage_properties.cpp)
target_link_libraries(coverage_tests PRIVATE penumbra_wedges penumbra_reference penumbra_scenes penumbra_warnings
                                             ${RAPIDCHECK} GTest::gtest_main)
gtest_discover_tests(coverage_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

include(${PROJECT_SOURCE_DIR}/cmake/cgal_corpus.cmake)
add_executable(coverage_mesh_tests ${CMAKE_CURRENT_LIST_DIR}/agreement/coverage_meshes.cpp)
target_link_libraries(coverage_mesh_tests PRIVATE penumbra_wedges penumbra_reference penumbra_scenes penumbra_warnings
                                                  GTest::gtest_main)
penumbra_cgal_corpus(coverage_mesh_tests)
gtest_discover_tests(coverage_mesh_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(coverage_mesh_tests TEST_FILTER "*Full" TEST_LIST coverage_mesh_full_tests
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 7200)

find_package(nlohmann_json REQUIRED)
add_executable(explain_cli_test ${CMAKE_CURRENT_LIST_DIR}/cli/explain_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cli/program.cpp)
target_compile_definitions(explain_cli_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
find_package(ZLIB REQUIRED)
target_link_libraries(explain_cli_test PRIVATE penumbra_visibility penumbra_warnings nlohmann_json::nlohmann_json
                                               GTest::gmock GTest::gtest_main ZLIB::ZLIB)
target_include_directories(explain_cli_test PRIVATE ${PROJECT_SOURCE_DIR})
add_dependencies(explain_cli_test penumbra)
gtest_discover_tests(explain_cli_test TEST_PREFIX cli. PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
