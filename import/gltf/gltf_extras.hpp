#pragma once

#include <string>

namespace tinygltf {
class Node;
struct Mesh;
}  // namespace tinygltf

namespace penumbra::scenes {

/// What extras (Blender's custom properties) of a node, or else of its mesh, say that glTF has no word for: booleans,
/// or numbers, 0 and 1; or a name.
struct ObjectFlags {
  bool casts_shadow = true;     ///< "castsShadow"
  bool receives_shadow = true;  ///< "receivesShadow"
  bool body = true;             ///< "body": false: an emissive mesh only says where its light is
  std::string light_name;       ///< "lightName", of an emissive mesh's light; empty: the mesh's own
};

/// Throws InputError for an entry of these names that is not of its kind.
ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh);

/// Does a lamp cast shadows? "castsShadow" of its node; throws likewise.
bool lamp_casts_shadows(const tinygltf::Node& node);

}  // namespace penumbra::scenes
