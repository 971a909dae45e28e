# The program where the system says no: limits, streams, disks, kills. The long searches are those called Long….
add_executable(faults_test
  faults/child.cpp
  faults/disks.cpp
  faults/kills.cpp
  faults/limits.cpp
  faults/memory.cpp
  faults/orphans.cpp
  faults/outputs.cpp
  faults/streams.cpp
  faults/waits.cpp)
add_library(penumbra_interpose MODULE faults/interpose.cpp)  # what LD_PRELOAD names
target_link_libraries(penumbra_interpose PRIVATE penumbra_warnings ${CMAKE_DL_LIBS})
target_compile_definitions(faults_test PRIVATE PENUMBRA_PROGRAM="$<TARGET_FILE:penumbra>"
                           PENUMBRA_INTERPOSE="$<TARGET_FILE:penumbra_interpose>")
target_link_libraries(faults_test PRIVATE penumbra_base penumbra_warnings GTest::gmock GTest::gtest_main)
add_dependencies(faults_test penumbra penumbra_interpose)
gtest_discover_tests(faults_test TEST_PREFIX faults. TEST_FILTER -*Long* TEST_LIST faults_quick
                     PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(faults_test TEST_PREFIX faults. TEST_FILTER *Long* TEST_LIST faults_full
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 3600)
