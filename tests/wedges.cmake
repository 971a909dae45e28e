# Penumbra wedges: bounds proved by exact signs, validation, export. No device.
include(${PROJECT_SOURCE_DIR}/cmake/cgal_corpus.cmake)
find_package(nlohmann_json REQUIRED)
find_library(GMP_LIBRARY gmp REQUIRED)
find_library(GMPXX_LIBRARY gmpxx REQUIRED)

add_executable(wedges_tests ${CMAKE_CURRENT_LIST_DIR}/property/penumbra_wedges.cpp
                            ${CMAKE_CURRENT_LIST_DIR}/property/wedge_polyhedra.cpp)
target_link_libraries(wedges_tests PRIVATE penumbra_wedges penumbra_warnings ${GMPXX_LIBRARY} ${GMP_LIBRARY}
                                           GTest::gtest_main)
gtest_discover_tests(wedges_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(wedge_validation_tests ${CMAKE_CURRENT_LIST_DIR}/property/wedge_validation.cpp
                                      ${CMAKE_CURRENT_LIST_DIR}/property/wedge_corpus.cpp)
target_compile_definitions(wedge_validation_tests PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(wedge_validation_tests PRIVATE penumbra_wedges penumbra_scenes penumbra_warnings GTest::gtest_main)
penumbra_cgal_corpus(wedge_validation_tests)
gtest_discover_tests(wedge_validation_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(wedge_validation_tests TEST_FILTER "*Full" TEST_LIST wedge_validation_full_tests
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 7200)

add_executable(wedges_cli_test ${CMAKE_CURRENT_LIST_DIR}/cli/wedges_test.cpp ${CMAKE_CURRENT_LIST_DIR}/cli/program.cpp)
target_compile_definitions(wedges_cli_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>"
                                                   PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(wedges_cli_test PRIVATE penumbra_warnings nlohmann_json::nlohmann_json GTest::gmock
                                              GTest::gtest_main)
target_include_directories(wedges_cli_test PRIVATE ${PROJECT_SOURCE_DIR})
add_dependencies(wedges_cli_test penumbra)
gtest_discover_tests(wedges_cli_test TEST_PREFIX cli. PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
