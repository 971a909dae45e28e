# Foreign files: meshes, glTF scenes, and the helper process that reads them.
find_package(GTest REQUIRED)
find_package(nlohmann_json REQUIRED)
find_library(RAPIDCHECK rapidcheck REQUIRED)
find_package(PkgConfig REQUIRED)
pkg_check_modules(MINIZIP REQUIRED IMPORTED_TARGET minizip)

add_executable(mesh_import_test unit/mesh/mesh_import_test.cpp unit/mesh/mesh_readers_test.cpp unit/mesh/import_helper_test.cpp)
target_link_libraries(mesh_import_test PRIVATE
  penumbra_mesh PkgConfig::MINIZIP penumbra_warnings GTest::gmock GTest::gtest_main)
gtest_discover_tests(mesh_import_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(polygon_property_test property/polygon_property_test.cpp)
target_link_libraries(polygon_property_test PRIVATE penumbra_mesh_reader penumbra_warnings ${RAPIDCHECK} GTest::gtest_main)
gtest_discover_tests(polygon_property_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(gltf_reader_test unit/gltf_reader_test.cpp unit/flat_light_test.cpp unit/mesh/input_file_test.cpp)
target_link_libraries(gltf_reader_test PRIVATE
  penumbra_scenes penumbra_gltf_import penumbra_warnings nlohmann_json::nlohmann_json GTest::gmock GTest::gtest_main)
gtest_discover_tests(gltf_reader_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)

add_executable(import_corpus_test full/import_corpus_test.cpp)
target_link_libraries(import_corpus_test PRIVATE penumbra_scenes penumbra_warnings GTest::gtest_main)
gtest_discover_tests(import_corpus_test PROPERTIES LABELS full DISCOVERY_TIMEOUT 120 TIMEOUT 3600)

# Every surface of the files of two packages, counted independently.
add_executable(mesh_face_counts_test
  agreement/face_counters_binary.cpp agreement/face_counters_text.cpp agreement/mesh_face_counts.cpp)
target_link_libraries(mesh_face_counts_test PRIVATE
  penumbra_mesh nlohmann_json::nlohmann_json PkgConfig::MINIZIP penumbra_warnings GTest::gtest_main)
penumbra_cgal_corpus(mesh_face_counts_test)
gtest_discover_tests(mesh_face_counts_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
