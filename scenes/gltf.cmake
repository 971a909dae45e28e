# The import helper, and the half of the readers of glTF and textures that runs inside it; the other half (gltf_reader.cpp,
# scene_wire.cpp) is part of penumbra_scenes.
find_package(nlohmann_json REQUIRED)

# tinygltf, for everybody who uses it. libdraco, which Assimp brings along, exports a copy of it with another class
# layout, and whichever of the two is linked first serves both: so ours gets a namespace of its own. Debian's
# libtinygltf cannot have that, hence its header alone. Foreign code: our warnings are not for it.
add_library(penumbra_tinygltf STATIC tinygltf_library.cpp)
target_compile_definitions(penumbra_tinygltf PUBLIC tinygltf=penumbra_tinygltf
  TINYGLTF_NO_STB_IMAGE TINYGLTF_NO_STB_IMAGE_WRITE TINYGLTF_NO_EXTERNAL_IMAGE TINYGLTF_NO_INCLUDE_JSON)
target_link_libraries(penumbra_tinygltf PUBLIC nlohmann_json::nlohmann_json)

add_library(penumbra_gltf_import STATIC
  flat_light.cpp gltf_accessor.cpp gltf_import.cpp gltf_load.cpp gltf_nodes.cpp gltf_numbers.cpp scene_wire.cpp texture_file.cpp)
target_include_directories(penumbra_gltf_import PUBLIC ${PROJECT_SOURCE_DIR})
target_link_libraries(penumbra_gltf_import PUBLIC penumbra_import_wire penumbra_base PRIVATE penumbra_tinygltf penumbra_warnings)

add_executable(penumbra-import import_main.cpp)
target_link_libraries(penumbra-import PRIVATE penumbra_mesh_reader penumbra_gltf_import penumbra_import_wire penumbra_warnings)
