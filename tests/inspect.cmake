# inspect, as a user meets it.
find_package(nlohmann_json REQUIRED)
add_executable(inspect_test cli/inspect_test.cpp cli/program.cpp)
target_compile_definitions(inspect_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
target_link_libraries(inspect_test PRIVATE penumbra_mesh penumbra_warnings
                      nlohmann_json::nlohmann_json GTest::gmock GTest::gtest_main)
add_dependencies(inspect_test penumbra)
gtest_discover_tests(inspect_test TEST_PREFIX cli. PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
