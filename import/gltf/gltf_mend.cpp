// SPDX-License-Identifier: Apache-2.0
// Changes a file's JSON where tinygltf refuses or misreads constructs that glTF 2.0 or its extensions allow: targets of
// KHR_animation_pointer, data URIs of other media types, Draco primitives with an uncompressed copy.

#include "import/gltf/gltf_mend.hpp"

#include "base/error.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <string_view>

namespace penumbra::import {
namespace {

using nlohmann::json;

/// Returns the array of this name; null if there is none.
json* array_of(json& owner, const char* name) {
  if (!owner.is_object()) return nullptr;
  const auto found = owner.find(name);
  return found != owner.end() && found->is_array() ? &*found : nullptr;
}

json* object_of(json& owner, const char* name) {
  if (!owner.is_object()) return nullptr;
  const auto found = owner.find(name);
  return found != owner.end() && found->is_object() ? &*found : nullptr;
}

struct NodePath {
  std::uint64_t node = 0;
  std::string path;
};

/// Parses "/nodes/N/translation" and similar pointers.
std::optional<NodePath> node_path_of(std::string_view pointer) {
  constexpr std::string_view kNodes = "/nodes/";
  if (!pointer.starts_with(kNodes)) return std::nullopt;
  pointer.remove_prefix(kNodes.size());
  const std::size_t slash = pointer.find('/');
  if (slash == std::string_view::npos) return std::nullopt;
  NodePath found;
  const auto [end, error] = std::from_chars(pointer.data(), pointer.data() + slash, found.node);
  if (error != std::errc() || end != pointer.data() + slash) return std::nullopt;
  found.path = pointer.substr(slash + 1);
  constexpr std::array kPaths = {"translation", "rotation", "scale", "weights"};
  if (std::ranges::find(kPaths, found.path) == kPaths.end()) return std::nullopt;
  return found;
}

/// Returns the target of KHR_animation_pointer; nullopt if there is none.
std::optional<std::string> pointer_of(json& target) {
  json* const extensions = object_of(target, "extensions");
  json* const extension = extensions == nullptr ? nullptr : object_of(*extensions, "KHR_animation_pointer");
  if (extension == nullptr || !extension->contains("pointer") || !(*extension)["pointer"].is_string())
    return std::nullopt;
  return (*extension)["pointer"].get<std::string>();
}

/// Converts the target to one of glTF 2.0. Returns false if the channel must be removed.
bool mend_target(json& target, std::size_t clip, TakenOut& taken_out, bool& changed) {
  const bool by_pointer = target.contains("path") && target["path"] == "pointer";
  if (!by_pointer) {
    if (target.contains("node")) return true;
    ++taken_out.channels_without_node;
    return false;
  }
  const std::string pointer = pointer_of(target).value_or("");
  if (const auto path = node_path_of(pointer)) {
    target["node"] = path->node;
    target["path"] = path->path;
    return changed = true;
  }
  const TakenOut::Pointer found{pointer, clip};
  if (std::ranges::find(taken_out.pointers, found) == taken_out.pointers.end()) taken_out.pointers.push_back(found);
  return false;
}

bool mend_animations(json& document, TakenOut& taken_out) {
  json* const animations = array_of(document, "animations");
  if (animations == nullptr) return false;
  bool changed = false;
  for (std::size_t clip = 0; clip < animations->size(); ++clip) {
    json* const channels = array_of((*animations)[clip], "channels");
    if (channels == nullptr) continue;
    json kept = json::array();
    for (json& channel : *channels) {
      json* const target = object_of(channel, "target");
      if (target == nullptr || mend_target(*target, clip, taken_out, changed)) kept.push_back(std::move(channel));
    }
    changed |= kept.size() != channels->size();
    *channels = std::move(kept);
  }
  return changed;
}

/// A data URI in base64, in two parts.
struct DataUri {
  std::string_view media_type, content;
};

std::optional<DataUri> data_uri_of(std::string_view uri) {
  constexpr std::string_view kScheme = "data:", kEncoding = ";base64";
  if (!uri.starts_with(kScheme)) return std::nullopt;
  const std::size_t comma = uri.find(',');
  std::string_view head = uri.substr(0, comma);
  if (comma == std::string_view::npos || !head.ends_with(kEncoding)) return std::nullopt;
  head.remove_prefix(kScheme.size());
  head.remove_suffix(kEncoding.size());
  return DataUri{head, uri.substr(comma + 1)};
}

/// Returns base64 without percent escapes and blanks, which browsers accept: the same bytes.
std::string plain_base64(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char letter = text[i];
    if (unsigned code = 0;
        letter == '%' && i + 2 < text.size() &&
        std::from_chars(text.data() + i + 1, text.data() + i + 3, code, 16).ptr == text.data() + i + 3) {
      letter = static_cast<char>(code);
      i += 2;
    }
    if (letter != ' ' && letter != '\n' && letter != '\r' && letter != '\t') plain += letter;
  }
  return plain;
}

std::uint64_t decoded_size(std::string_view base64) {
  while (base64.ends_with('=')) base64.remove_suffix(1);
  return base64.size() / 4 * 3 + base64.size() % 4 * 3 / 4;
}

/// Gives the `uri` of a buffer or image a media type that tinygltf supports. Returns the number of its bytes; nullopt
/// if it is not a data URI, 0 if it is one that is not in base64.
std::optional<std::uint64_t> mend_uri(json& owner, bool& changed) {
  if (!owner.is_object() || !owner.contains("uri") || !owner["uri"].is_string()) return std::nullopt;
  auto& uri = owner["uri"].get_ref<std::string&>();
  if (!uri.starts_with("data:")) {
    // tinygltf decodes a plus sign as a blank, as web forms do; in file names it stands for itself.
    for (std::size_t at = uri.find('+'); at != std::string::npos; at = uri.find('+', at)) {
      uri.replace(at, 1, "%2B");
      changed = true;
    }
    return std::nullopt;
  }
  const auto data = data_uri_of(uri);
  if (!data) return 0;
  if (data->media_type == "application/octet-stream" &&
      data->content.find_first_of("% \n\r\t") == std::string_view::npos)
    return decoded_size(data->content);
  const std::string content = plain_base64(data->content);
  owner["uri"] = "data:application/octet-stream;base64," + content;
  changed = true;
  return decoded_size(content);
}

bool mend_uris(json& document, const std::string& file) {
  bool changed = false;
  if (json* const images = array_of(document, "images")) {
    for (json& image : *images) {
      if (mend_uri(image, changed) != 0) continue;
      // The data URI cannot be decoded as a picture; unreplaced, tinygltf would take it for the name of a file.
      image["uri"] = "data:application/octet-stream;base64,AAAA";
      changed = true;
    }
  }
  json* const buffers = array_of(document, "buffers");
  for (std::size_t i = 0; buffers != nullptr && i < buffers->size(); ++i) {
    json& buffer = (*buffers)[i];
    const std::string place = fmt::format("{}: /buffers/{}", file, i);
    const auto size = mend_uri(buffer, changed);
    if (size == 0) throw InputError("{}/uri: a data URI that is empty, or not in base64", place);
    if (!size || !buffer.contains("byteLength") || !buffer["byteLength"].is_number_unsigned()) continue;
    const auto wanted = buffer["byteLength"].get<std::uint64_t>();
    if (*size < wanted)
      throw InputError("{}/uri: {} bytes; byteLength says {}. The file is damaged", place, *size, wanted);
    changed |= *size != wanted;
    buffer["byteLength"] = *size;
  }
  return changed;
}

/// Returns whether the accessor has its own data.
bool has_data(json& document, const json& accessor) {
  const json* const accessors = array_of(document, "accessors");
  if (accessors == nullptr || !accessor.is_number_unsigned() || accessor.get<std::uint64_t>() >= accessors->size())
    return true;  // refused elsewhere
  const json& found = (*accessors)[accessor.get<std::size_t>()];
  return found.contains("bufferView") || found.contains("sparse");
}

bool has_uncompressed_copy(json& document, json& primitive) {
  if (primitive.contains("indices") && !has_data(document, primitive["indices"])) return false;
  json* const attributes = object_of(primitive, "attributes");
  if (attributes == nullptr) return true;
  return std::ranges::all_of(*attributes, [&](const json& accessor) { return has_data(document, accessor); });
}

bool mend_draco(json& document, const std::string& file, bool lenient, TakenOut& taken_out) {
  constexpr const char* kDraco = "KHR_draco_mesh_compression";
  json* const meshes = array_of(document, "meshes");
  bool changed = false;
  for (std::size_t m = 0; meshes != nullptr && m < meshes->size(); ++m) {
    json* const primitives = array_of((*meshes)[m], "primitives");
    if (primitives == nullptr) continue;
    json kept = json::array();
    for (std::size_t p = 0; p < primitives->size(); ++p) {
      json& primitive = (*primitives)[p];
      json* const extensions = object_of(primitive, "extensions");
      const bool compressed = extensions != nullptr && extensions->contains(kDraco);
      if (compressed && !has_uncompressed_copy(document, primitive)) {
        const std::string place = fmt::format("/meshes/{}/primitives/{}", m, p);
        if (!lenient) {
          throw InputError(
              "{}: {}: its vertices are compressed with {}, which is not supported; export without compression", file,
              place, kDraco);
        }
        taken_out.compressed.push_back(place);
        changed = true;
        continue;
      }
      if (compressed) {
        extensions->erase(kDraco);
        changed = true;
      }
      kept.push_back(std::move(primitive));
    }
    *primitives = std::move(kept);
  }
  return changed;
}

/// Lists nodes with both a matrix and translation, rotation or scale. tinygltf reads the matrix if there is one, and
/// else the other parts; so do three.js and Blender.
void name_overruled(json& document, TakenOut& taken_out) {
  const json* const nodes = array_of(document, "nodes");
  for (std::size_t i = 0; nodes != nullptr && i < nodes->size(); ++i) {
    const json& node = (*nodes)[i];
    if (!node.contains("matrix")) continue;
    if (!node.contains("translation") && !node.contains("rotation") && !node.contains("scale")) continue;
    const auto name = node.find("name");
    taken_out.overruled.push_back(name != node.end() && name->is_string() ? name->get<std::string>()
                                                                          : fmt::format("node {}", i));
  }
}

}  // namespace

bool mend_gltf(json& document, const std::string& file, bool lenient, TakenOut& taken_out) {
  if (const json* const required = array_of(document, "extensionsRequired")) {
    for (const char* extension : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) {
      if (std::ranges::find(*required, json(extension)) != required->end())
        throw InputError("{}: /extensionsRequired: {} is not supported; export without compression", file, extension);
    }
  }
  bool changed = mend_animations(document, taken_out);
  changed |= mend_uris(document, file);
  changed |= mend_draco(document, file, lenient, taken_out);
  name_overruled(document, taken_out);
  return changed;
}

}  // namespace penumbra::import
