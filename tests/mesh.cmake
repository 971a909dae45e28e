# SPDX-License-Identifier: Apache-2.0
# Tests of meshes: readers through the child process, exact predicates, the edge graph, silhouettes, half-edges,
# diagnosis.
find_package(CGAL REQUIRED)
penumbra_test(mesh FULL CgalMeshes.All
  SOURCES
  agreement/mesh/face_counters_binary.cpp
  agreement/mesh/face_counters_text.cpp
  agreement/mesh/face_counts.cpp
  property/mesh/broken_meshes.cpp
  property/mesh/diagnosis_oracle.cpp
  property/mesh/diagnosis_properties.cpp
  property/mesh/predicates.cpp
  property/mesh/silhouettes.cpp
  unit/mesh/import_helper.cpp
  unit/mesh/corpus.cpp
  unit/mesh/diagnosis.cpp
  unit/mesh/diagnosis_places.cpp
  unit/mesh/edge_graph.cpp
  unit/mesh/half_edge_view.cpp
  unit/mesh/import.cpp
  unit/mesh/readers.cpp
  unit/mesh/readers_xml.cpp
  unit/mesh/soup_ply.cpp
  APART property/mesh/diagnosis_oracle.cpp
  # GMP's rationals check the exact predicates: an independent library and formula.
  LIBRARIES penumbra_mesh CGAL::CGAL PkgConfig::MINIZIP nlohmann_json::nlohmann_json ${RAPIDCHECK} TBB::tbb gmpxx gmp)
penumbra_cgal_corpus(mesh_test)
if(PENUMBRA_WITH_CGAL_GPL)
  # Polygon_mesh_processing is under the GPL: among the programs, penumbra-repair alone uses it; tests may, too.
  target_compile_definitions(mesh_test PRIVATE PENUMBRA_WITH_CGAL_GPL)
  add_dependencies(mesh_test penumbra-repair)
  target_sources(mesh_test PRIVATE agreement/mesh/diagnosis_cgal.cpp)
  set_source_files_properties(agreement/mesh/diagnosis_cgal.cpp PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()
