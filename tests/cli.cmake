# The program as a user meets it: exit codes, messages, files.
find_package(nlohmann_json REQUIRED)
add_executable(cli_test
  cli/bad_input_test.cpp
  cli/compare_test.cpp
  cli/covering_array.cpp
  cli/interrupt_test.cpp
  cli/options_test.cpp
  cli/options_together_support.cpp
  cli/options_together_test.cpp
  cli/program.cpp
  cli/render_test.cpp
  cli/tables_test.cpp)
target_compile_definitions(cli_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
target_link_libraries(cli_test PRIVATE penumbra_app penumbra_visibility penumbra_base penumbra_warnings
                      nlohmann_json::nlohmann_json GTest::gmock GTest::gtest_main)
add_dependencies(cli_test penumbra)
gtest_discover_tests(cli_test TEST_PREFIX cli. TEST_FILTER "-*EveryTriple*" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(cli_test TEST_PREFIX cli. TEST_FILTER "*EveryTriple*" TEST_LIST cli_test_full
                     PROPERTIES LABELS full TIMEOUT 7200 DISCOVERY_TIMEOUT 120)

# Every mesh of two packages through inspect and compare; prints a table.
include(${PROJECT_SOURCE_DIR}/cmake/cgal_corpus.cmake)
find_package(PkgConfig REQUIRED)
pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)
add_executable(corpus_sweep_test
  agreement/face_counters_binary.cpp agreement/face_counters_text.cpp cli/program.cpp full/corpus_sweep_test.cpp)
target_compile_definitions(corpus_sweep_test PRIVATE
  PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>" PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(corpus_sweep_test PRIVATE
  penumbra_mesh PkgConfig::MINIZIP penumbra_warnings nlohmann_json::nlohmann_json GTest::gtest_main)
penumbra_cgal_corpus(corpus_sweep_test)
add_dependencies(corpus_sweep_test penumbra)
gtest_discover_tests(corpus_sweep_test PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 7200)
