# What the child process does: polygons of any shape, glTF, and files that are opened once.
penumbra_test(import FULL ImportCorpus.*
  SOURCES
  agreement/import_corpus.cpp
  property/polygon_property.cpp
  unit/flat_light.cpp
  unit/gltf_animation.cpp
  unit/gltf_reader.cpp
  unit/gltf_surfaces.cpp
  unit/mesh/input_file.cpp
  unit/sphere_light.cpp
  LIBRARIES penumbra_scenes penumbra_gltf_import penumbra_mesh_reader nlohmann_json::nlohmann_json ${RAPIDCHECK})
