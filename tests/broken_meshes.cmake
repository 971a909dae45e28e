# The generator of broken meshes, and view-sample mapping on what it makes and on real meshes with flaws.
include(${PROJECT_SOURCE_DIR}/cmake/cgal_corpus.cmake)

add_executable(broken_meshes_test ${CMAKE_CURRENT_LIST_DIR}/property/broken_meshes_test.cpp)
target_link_libraries(broken_meshes_test PRIVATE penumbra_mesh penumbra_warnings GTest::gtest_main)
gtest_discover_tests(broken_meshes_test TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(broken_meshes_test TEST_FILTER "*Full" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120)

add_executable(broken_agreement_tests ${CMAKE_CURRENT_LIST_DIR}/agreement/broken_meshes_raytrace.cpp)
target_link_libraries(broken_agreement_tests PRIVATE
  penumbra_vsm penumbra_volumes penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
penumbra_cgal_corpus(broken_agreement_tests)
gtest_discover_tests(broken_agreement_tests TEST_FILTER "-*Full" PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(broken_agreement_tests TEST_FILTER "*Full" PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 3600)

add_executable(metamorphic_tests ${CMAKE_CURRENT_LIST_DIR}/property/view_sample_metamorphic.cpp)
target_link_libraries(metamorphic_tests PRIVATE
  penumbra_vsm penumbra_volumes penumbra_reference penumbra_scenes penumbra_warnings GTest::gtest_main TBB::tbb)
gtest_discover_tests(metamorphic_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
