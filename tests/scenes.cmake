# Scenes (all but glTF), generated shapes, and files that appear whole or not at all.
find_package(nlohmann_json REQUIRED)

add_executable(scenes_test
  unit/scenes_atomic_file_test.cpp
  unit/scenes_files_test.cpp
  unit/scenes_float_rounding_test.cpp
  unit/scenes_json_test.cpp
  unit/scenes_shapes_test.cpp
  unit/scenes_shipped_test.cpp
  unit/scenes_writer_test.cpp
)
target_compile_definitions(scenes_test PRIVATE PENUMBRA_SCENES="${PROJECT_SOURCE_DIR}/scenes")
target_link_libraries(scenes_test PRIVATE
  penumbra_scenes nlohmann_json::nlohmann_json GTest::gtest_main penumbra_warnings)
gtest_discover_tests(scenes_test PROPERTIES LABELS quick DISCOVERY_TIMEOUT 120)
