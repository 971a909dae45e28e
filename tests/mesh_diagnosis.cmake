# The diagnosis of meshes: closed forms, definitions by brute force, and CGAL's own functions on its own meshes.
find_package(CGAL REQUIRED)
find_package(GTest REQUIRED)

add_executable(mesh_diagnosis_test
  unit/mesh/mesh_diagnosis_test.cpp property/mesh_diagnosis_properties.cpp property/diagnosis_oracle.cpp)
target_link_libraries(mesh_diagnosis_test PRIVATE
  penumbra_mesh penumbra_warnings CGAL::CGAL GTest::gmock GTest::gtest_main)
# Two tests to ctest: hundreds of processes for as many seeds would take longer than the seeds.
add_test(NAME mesh_diagnosis.closed_forms COMMAND mesh_diagnosis_test --gtest_filter=Diagnosis.*)
add_test(NAME mesh_diagnosis.lattice_soups COMMAND mesh_diagnosis_test --gtest_filter=Seeds/Soups.*)
set_tests_properties(mesh_diagnosis.closed_forms mesh_diagnosis.lattice_soups PROPERTIES LABELS quick)

# Polygon_mesh_processing is GPL; the test, never the program, links it.
if(PENUMBRA_WITH_CGAL_GPL)
  add_executable(mesh_diagnosis_cgal_test agreement/mesh_diagnosis_cgal.cpp)
  penumbra_cgal_corpus(mesh_diagnosis_cgal_test)
  target_link_libraries(mesh_diagnosis_cgal_test PRIVATE penumbra_mesh penumbra_warnings CGAL::CGAL GTest::gtest_main)
  add_test(NAME mesh_diagnosis_cgal.small COMMAND mesh_diagnosis_cgal_test --gtest_filter=CgalMeshes.Small)
  add_test(NAME mesh_diagnosis_cgal.all COMMAND mesh_diagnosis_cgal_test --gtest_filter=CgalMeshes.All)
  set_tests_properties(mesh_diagnosis_cgal.small PROPERTIES LABELS quick)
  set_tests_properties(mesh_diagnosis_cgal.all PROPERTIES LABELS full TIMEOUT 3600)
endif()
