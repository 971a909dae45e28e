# The edge graph, exact predicates and silhouettes, and the sum of signed crossings that stands on them.
find_package(TBB REQUIRED)
find_library(RAPIDCHECK rapidcheck REQUIRED)

add_executable(mesh_edges_tests
  ${CMAKE_CURRENT_LIST_DIR}/property/mesh_predicates.cpp
  ${CMAKE_CURRENT_LIST_DIR}/property/mesh_silhouettes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/unit/mesh/mesh_edge_graph.cpp)
# GMP's rationals are the judge of the exact predicates: another library, another formula.
target_link_libraries(mesh_edges_tests PRIVATE
  penumbra_mesh penumbra_warnings ${RAPIDCHECK} GTest::gtest_main TBB::tbb gmpxx gmp)
gtest_discover_tests(mesh_edges_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(signed_crossings_tests ${CMAKE_CURRENT_LIST_DIR}/property/signed_crossings.cpp)
target_link_libraries(signed_crossings_tests PRIVATE penumbra_visibility penumbra_warnings GTest::gtest_main)
gtest_discover_tests(signed_crossings_tests PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
