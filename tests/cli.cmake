# The program as a user meets it: exit codes, messages, files.
find_package(nlohmann_json REQUIRED)
add_executable(cli_test
  cli/bad_input_test.cpp
  cli/compare_test.cpp
  cli/interrupt_test.cpp
  cli/options_test.cpp
  cli/program.cpp
  cli/render_test.cpp
  cli/tables_test.cpp)
target_compile_definitions(cli_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
target_link_libraries(cli_test PRIVATE penumbra_app penumbra_visibility penumbra_base penumbra_warnings
                      nlohmann_json::nlohmann_json GTest::gmock GTest::gtest_main)
add_dependencies(cli_test penumbra)
gtest_discover_tests(cli_test TEST_PREFIX cli. PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
