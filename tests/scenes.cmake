# SPDX-License-Identifier: Apache-2.0
# Tests of scenes (all formats but glTF), generated shapes, and files that appear whole or not at all.
penumbra_test(scenes
  SOURCES
  unit/scenes/atomic_file.cpp
  unit/scenes/files.cpp
  unit/scenes/float_rounding.cpp
  unit/scenes/joined_parts.cpp
  unit/scenes/json.cpp
  unit/scenes/json_schema.cpp
  unit/scenes/json_scene.cpp
  unit/scenes/light_kinds.cpp
  unit/scenes/shapes.cpp
  unit/scenes/shipped.cpp
  unit/scenes/studio.cpp
  unit/scenes/wire.cpp
  unit/scenes/writer.cpp
  unit/scenes/writer_glb.cpp
  LIBRARIES penumbra_scenes nlohmann_json::nlohmann_json)
find_path(VALIJSON_INCLUDE_DIR valijson/validator.hpp REQUIRED)  # the library against which the schema of scenes is tested
target_include_directories(scenes_test SYSTEM PRIVATE ${VALIJSON_INCLUDE_DIR})
# g++ 12 with sanitizers falsely warns that std::regex, which valijson uses, may be used uninitialised.
target_compile_options(scenes_test PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)
