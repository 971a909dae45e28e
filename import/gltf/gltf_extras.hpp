#pragma once

#include "scenes/losses.hpp"

#include <optional>
#include <string>

namespace tinygltf {
class Node;
class Value;
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

/// An entry of these names that is of another kind is another tool's: it counts as not there, and goes to the losses.
ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh, Losses& losses);

/// Does a lamp cast shadows? "castsShadow" of its node, read likewise.
bool lamp_casts_shadows(const tinygltf::Node& node, Losses& losses);

/// True or false of extras, or 1 or 0, read likewise; `owner` is whose they are.
std::optional<bool> flag_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                   Losses& losses);

/// A number of extras, read likewise.
std::optional<double> number_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                       Losses& losses);

}  // namespace penumbra::scenes
