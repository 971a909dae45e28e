# The program where the system says no: limits, streams, disks, kills. The long searches are those called Long….
add_executable(faults_test
  faults/child.cpp
  faults/limits.cpp
  faults/orphans.cpp
  faults/streams.cpp)
target_compile_definitions(faults_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>")
target_link_libraries(faults_test PRIVATE penumbra_base penumbra_warnings GTest::gmock GTest::gtest_main)
add_dependencies(faults_test penumbra)
gtest_discover_tests(faults_test TEST_PREFIX faults. TEST_FILTER -*.Long* TEST_LIST faults_quick
                     PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(faults_test TEST_PREFIX faults. TEST_FILTER *.Long* TEST_LIST faults_full
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 3600)
