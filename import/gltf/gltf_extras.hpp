// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "scenes/losses.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace tinygltf {
class Node;
class Value;
struct Mesh;
}  // namespace tinygltf

namespace penumbra::import {

/// Properties in the extras (Blender's custom properties) of a node, or else of its mesh, that glTF does not have:
/// booleans, or numbers 0 and 1; or a name.
struct ObjectFlags {
  bool casts_shadow = true;     ///< "castsShadow"
  bool receives_shadow = true;  ///< "receivesShadow"
  bool body = true;             ///< "body": false for an emissive mesh that only marks the place of its light
  std::string light_name;       ///< "lightName", name of an emissive mesh's light; empty: the mesh's name
};

/// Reads the flags. An entry with one of these names and another type belongs to another tool: it is ignored, and added
/// to the losses.
ObjectFlags flags_of(const tinygltf::Node& node, const tinygltf::Mesh& mesh, scenes::Losses& losses);

/// Returns whether a lamp casts shadows: "castsShadow" of its node, read as by flags_of.
bool lamp_casts_shadows(const tinygltf::Node& node, scenes::Losses& losses);

/// Returns true or false, or 1 or 0, of an entry of extras, read as by flags_of; `owner` names its owner in messages.
std::optional<bool> flag_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                   scenes::Losses& losses);

/// Returns a number of extras, read as by flags_of.
std::optional<double> number_of_extras(const tinygltf::Value& extras, const char* key, const std::string& owner,
                                       scenes::Losses& losses);

/// Reads a list of `count` finite numbers, each at least `least`, under `key` of an object. Throws InputError, whose
/// message begins with `place`, for anything else.
std::vector<double> list_of_extras(const tinygltf::Value& object, const char* key, std::size_t count, double least,
                                   const std::string& place);

}  // namespace penumbra::import
