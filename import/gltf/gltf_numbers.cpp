// SPDX-License-Identifier: Apache-2.0
// Checks each integer of a file by its JSON pointer before tinygltf reads the file: tinygltf would take 2³² + 1 as 1,
// and a fraction as its integer part.

#include "import/gltf/gltf_numbers.hpp"

#include "base/error.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace penumbra::import {
namespace {

using nlohmann::json;

/// JSON pointers of non-negative integers; a star is any index or name. tinygltf stores them in an int.
constexpr std::array kNumbers = {
    "/scene",
    "/scenes/*/nodes/*",
    "/nodes/*/mesh",
    "/nodes/*/camera",
    "/nodes/*/skin",
    "/nodes/*/children/*",
    "/meshes/*/primitives/*/indices",
    "/meshes/*/primitives/*/material",
    "/meshes/*/primitives/*/mode",
    "/meshes/*/primitives/*/attributes/*",
    "/meshes/*/primitives/*/targets/*/*",
    "/accessors/*/bufferView",
    "/accessors/*/componentType",
    "/accessors/*/sparse/count",
    "/accessors/*/sparse/indices/bufferView",
    "/accessors/*/sparse/indices/byteOffset",
    "/accessors/*/sparse/indices/componentType",
    "/accessors/*/sparse/values/bufferView",
    "/accessors/*/sparse/values/byteOffset",
    "/bufferViews/*/buffer",
    "/textures/*/source",
    "/textures/*/sampler",
    "/images/*/bufferView",
    "/materials/*/pbrMetallicRoughness/baseColorTexture/index",
    "/materials/*/pbrMetallicRoughness/baseColorTexture/texCoord",
    "/materials/*/pbrMetallicRoughness/baseColorTexture/extensions/KHR_texture_transform/texCoord",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture/index",
    "/materials/*/extensions/KHR_materials_pbrSpecularGlossiness/diffuseTexture/texCoord",
    "/materials/*/emissiveTexture/index",
    "/materials/*/emissiveTexture/texCoord",
    "/materials/*/emissiveTexture/extensions/KHR_texture_transform/texCoord",
    "/skins/*/joints/*",
    "/skins/*/inverseBindMatrices",
    "/animations/*/channels/*/sampler",
    "/animations/*/channels/*/target/node",
    "/animations/*/samplers/*/input",
    "/animations/*/samplers/*/output",
    "/nodes/*/extensions/KHR_lights_punctual/light",
    "/nodes/*/extensions/EXT_mesh_gpu_instancing/attributes/*",
};
/// JSON pointers of numbers that tinygltf stores in 64 bits.
constexpr std::array kSizes = {
    "/accessors/*/byteOffset",   "/accessors/*/count",        "/bufferViews/*/byteOffset",
    "/bufferViews/*/byteLength", "/bufferViews/*/byteStride", "/buffers/*/byteLength",
};

struct Expected {
  const std::string& file;
  std::uint64_t most;
};

void check_number(const json& value, const std::string& pointer, const Expected& expected) {
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= expected.most) return;
  throw InputError("{}: {}: {}; expected a whole number from 0 to {}", expected.file, pointer,
                   value.dump(-1, ' ', true, json::error_handler_t::replace).substr(0, 60), expected.most);
}

/// Checks the numbers that `rest` of a pattern reaches from `value`, which is at `pointer`.
void check_place(const json& value, std::string_view rest, const std::string& pointer, const Expected& expected) {
  if (rest.empty()) return check_number(value, pointer, expected);
  rest.remove_prefix(1);
  const std::string_view name = rest.substr(0, rest.find('/'));
  rest.remove_prefix(name.size());
  if (name != "*") {
    const auto found = value.is_object() ? value.find(name) : value.end();
    if (found != value.end()) check_place(*found, rest, fmt::format("{}/{}", pointer, name), expected);
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i)
      check_place(value[i], rest, fmt::format("{}/{}", pointer, i), expected);
  } else if (value.is_object()) {
    for (const auto& [key, member] : value.items())
      check_place(member, rest, fmt::format("{}/{}", pointer, key), expected);
  }
}

/// Returns whether an `asset.minVersion` (glTF 2.0, 5.9) is at most 2.0: "2.0", or "2" as some write.
bool is_two_zero(const json& version) {
  return version.is_string() && (version == "2.0" || version == "2");
}

}  // namespace

void check_gltf_numbers(const json& document, const std::string& file) {
  // glTF 1.0 has names where 2.0 has numbers; the helpful message is that the file has version 1.0.
  const auto asset = document.find("asset");
  const bool known = asset != document.end() && asset->is_object() && asset->contains("version");
  if (!known) {
    throw InputError("{}: /asset/version is missing; this is no glTF 2.0 file (glTF 1.0 is not supported)", file);
  }
  const json& version = (*asset)["version"];
  if (!version.is_string() || !version.get<std::string>().starts_with("2.")) {
    throw InputError("{}: /asset/version: glTF {} is not supported; export it again as glTF 2.0", file,
                     version.is_string() ? version.get<std::string>() : "of no version");
  }
  if (const auto least = asset->find("minVersion"); least != asset->end() && !is_two_zero(*least)) {
    throw InputError("{}: /asset/minVersion: a reader of glTF {} is required; glTF 2.0 is what is read", file,
                     least->is_string() ? least->get<std::string>() : least->dump());
  }
  constexpr std::uint64_t kInt = std::numeric_limits<std::int32_t>::max();
  for (const std::string_view place : kNumbers) check_place(document, place, "", {file, kInt});
  constexpr std::uint64_t kAny = std::numeric_limits<std::uint64_t>::max();
  for (const std::string_view place : kSizes) check_place(document, place, "", {file, kAny});
}

}  // namespace penumbra::import
