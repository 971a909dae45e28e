# Scenes (all but glTF), generated shapes, and files that appear whole or not at all.
penumbra_test(scenes
  SOURCES
  unit/scenes_atomic_file.cpp
  unit/scenes_files.cpp
  unit/scenes_float_rounding.cpp
  unit/scenes_json.cpp
  unit/scenes_shapes.cpp
  unit/scenes_shipped.cpp
  unit/scenes_writer.cpp
  LIBRARIES penumbra_scenes nlohmann_json::nlohmann_json)
