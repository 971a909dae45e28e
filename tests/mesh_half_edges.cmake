# The half-edge view, repair, and PLY files.
add_executable(mesh_half_edge_test unit/mesh/mesh_half_edge_view.cpp unit/mesh/mesh_soup_ply.cpp)
target_link_libraries(mesh_half_edge_test PRIVATE penumbra_mesh penumbra_warnings GTest::gtest_main)
gtest_discover_tests(mesh_half_edge_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(mesh_repair_test unit/mesh/mesh_repair.cpp)
target_link_libraries(mesh_repair_test PRIVATE penumbra_mesh penumbra_warnings GTest::gtest_main)
gtest_discover_tests(mesh_repair_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
if(PENUMBRA_WITH_CGAL_GPL)
  target_compile_definitions(mesh_repair_test PRIVATE PENUMBRA_WITH_CGAL_GPL)
endif()

add_executable(mesh_corpus_test unit/mesh/mesh_corpus.cpp)
target_link_libraries(mesh_corpus_test PRIVATE penumbra_mesh penumbra_warnings GTest::gtest_main)
penumbra_cgal_corpus(mesh_corpus_test)
gtest_discover_tests(mesh_corpus_test TEST_FILTER MeshCorpus.* PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
gtest_discover_tests(mesh_corpus_test TEST_FILTER MeshCorpusFull.* TEST_LIST mesh_corpus_full_tests
                     PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 3600)
