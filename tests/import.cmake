# SPDX-License-Identifier: Apache-2.0
# Tests of the import in a child process: polygons of any shape, glTF, and files that are opened only once.
penumbra_test(import FULL ImportCorpus.*
  SOURCES
  agreement/mesh/import_corpus.cpp
  property/polygon_property.cpp
  unit/import/emitter.cpp
  unit/import/flat_light.cpp
  unit/import/gltf_animation.cpp
  unit/import/gltf_as_written.cpp
  unit/import/foreign_scene.cpp
  unit/import/gltf_domes.cpp
  unit/import/gltf_lamps.cpp
  unit/import/gltf_reader.cpp
  unit/import/gltf_surfaces.cpp
  unit/import/input_file.cpp
  unit/import/ply_binary.cpp
  unit/import/sphere_light.cpp
  LIBRARIES penumbra_scenes penumbra_gltf_import penumbra_mesh_reader nlohmann_json::nlohmann_json ${RAPIDCHECK})
