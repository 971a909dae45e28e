#pragma once

namespace tinygltf {
class Node;
struct Mesh;
}  // namespace tinygltf

namespace penumbra::scenes {

/// What extras (Blender's custom properties) of a node, or else of its mesh, say that glTF has no word for: booleans,
/// or numbers, 0 and 1.
struct ObjectFlags {
  bool casts_shadow = true;     ///< "castsShadow"
  bool receives_shadow = true;  ///< "receivesShadow"
  bool body = true;             ///< "body": false: an emissive mesh only says where its light is
};

/// Throws InputError for an entry of these names that says neither.
ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh);

/// Does a lamp cast shadows? "castsShadow" of its node; throws likewise.
bool lamp_casts_shadows(const tinygltf::Node& node);

}  // namespace penumbra::scenes
